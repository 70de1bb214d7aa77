#include <limits>

#include <Eigen/Cholesky>

#include "tracking_metrics.h"

namespace object_modelling::benchmark_tracking
{
namespace
{
constexpr double CHI_SQUARE_6_95 = 12.591587;
}  // namespace

Nees neesOf(const std::vector<EstimateWithCovariance>& estimate, const std::vector<source::StampedPose>& truth,
            double tolerance_s)
{
  std::vector<source::StampedPose> poses;
  for (const EstimateWithCovariance& pose : estimate)
    poses.push_back(pose.pose);
  const auto matches = associate(poses, truth, tolerance_s);
  Nees result;
  std::vector<double> values;
  for (const auto& [i, j] : matches)
  {
    const geometry::Matrix6d& covariance = estimate[i].covariance;
    if (covariance.isZero(0))
      continue;
    const auto& [first_i, first_j] = matches.front();
    const Eigen::Isometry3d T_map_world = poses[first_i].T_map_camera * truth[first_j].T_map_camera.inverse();
    const geometry::Vector6d xi =
        geometry::vectorFromIsometry(T_map_world * truth[j].T_map_camera * poses[i].T_map_camera.inverse());
    const Eigen::LDLT<geometry::Matrix6d> factors(covariance);
    const bool valid = covariance.allFinite() && factors.info() == Eigen::Success && factors.isPositive();
    values.push_back(valid ? xi.dot(factors.solve(xi)) : std::numeric_limits<double>::infinity());
    result.within_ratio += values.back() <= CHI_SQUARE_6_95;
  }
  result.count = static_cast<int>(values.size());
  if (result.count == 0)
    return result;
  result.within_ratio /= result.count;
  result.median = statisticsOf(values).median;
  return result;
}

}  // namespace object_modelling::benchmark_tracking
