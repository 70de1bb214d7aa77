#include "object_modelling/rgbd/observation_weight.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/base/options.h"

namespace object_modelling::rgbd
{
namespace
{
double angleWeight(double theta_rad, double theta_max_rad)
{
  if (!(theta_rad < M_PI_2))
    return 0;
  return theta_rad <= theta_max_rad ? 1 : 1 - (theta_rad - theta_max_rad) / (M_PI_2 - theta_max_rad);
}

double edgeWeight(double edge_distance_m, const ObservationWeightOptions& options)
{
  const double ratio = edge_distance_m / options.sigma_lateral_m;
  if (options.model == WeightModel::PAPER_PRINTED)
    return ratio < 1 ? std::max(0.0, 1 - 0.5 * std::exp(ratio * ratio)) : 0;
  // exp(-36) is below the resolution of the float that the weight ends in; most pixels are that far from any edge.
  return ratio < 6 ? 1 - 0.5 * std::exp(-ratio * ratio) : 1;
}

cv::Mat paperWeights(const Frame& frame, const cv::Mat& normals, const cv::Mat& edge_distance_px,
                     const ObservationWeightOptions& options)
{
  const geometry::PinholeCamera& camera = frame.camera;
  const auto cos_theta_max = static_cast<float>(std::cos(options.theta_max_rad));
  const auto meters_per_px = static_cast<float>(2.0 / (camera.fx + camera.fy));  // at a depth of 1 m
  cv::Mat weights(frame.depth_m.size(), CV_32FC1);
  for (int v = 0; v < weights.rows; ++v)
  {
    const auto* depth_m = frame.depth_m.ptr<float>(v);
    const auto* normal = normals.ptr<cv::Vec3f>(v);
    const auto* distance_px = edge_distance_px.ptr<float>(v);
    auto* weight = weights.ptr<float>(v);
    const auto ray_y = static_cast<float>((v - camera.cy) / camera.fy);
    for (int u = 0; u < weights.cols; ++u)
    {
      const auto ray_x = static_cast<float>((u - camera.cx) / camera.fx);
      const cv::Vec3f& n = normal[u];
      const float length = std::sqrt(ray_x * ray_x + ray_y * ray_y + 1);
      const float cos_theta = -(n[0] * ray_x + n[1] * ray_y + n[2]) / length;
      weight[u] = 0;
      if (!(cos_theta > 0) || !(depth_m[u] > 0))
        continue;
      const double angle_weight =
          cos_theta >= cos_theta_max ? 1 : angleWeight(std::acos(cos_theta), options.theta_max_rad);
      const float distance_m = distance_px[u] * depth_m[u] * meters_per_px;
      weight[u] = static_cast<float>(angle_weight * edgeWeight(distance_m, options));
    }
  }
  return weights;
}

cv::Mat nguyenWeights(const Frame& frame, const cv::Mat& normals)
{
  const geometry::PinholeCamera& camera = frame.camera;
  cv::Mat weights = cv::Mat::zeros(frame.depth_m.size(), CV_32FC1);
  for (int v = 0; v < weights.rows; ++v)
    for (int u = 0; u < weights.cols; ++u)
    {
      const cv::Vec3f& n = normals.at<cv::Vec3f>(v, u);
      const double z_m = frame.depthAt_m(u, v);
      const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const double cos_theta = -ray.dot(Eigen::Vector3d(n[0], n[1], n[2])) / ray.norm();
      if (cos_theta > 0 && z_m > 0)
        weights.at<float>(v, u) =
            static_cast<float>(nguyenWeight(frame.noise_model, z_m, std::acos(std::min(cos_theta, 1.0))));
    }
  return weights;
}

}  // namespace

std::vector<std::string> ObservationWeightOptions::violations() const
{
  base::OptionsCheck check("observation_weight");
  check.inRange("theta_max_rad", theta_max_rad, 0.0, M_PI_2 - 1e-6);
  check.inRange("sigma_lateral_m", sigma_lateral_m, 1e-6, 1.0);
  return check.violations();
}

double paperWeight(double theta_rad, double edge_distance_m, const ObservationWeightOptions& options)
{
  return angleWeight(theta_rad, options.theta_max_rad) * edgeWeight(edge_distance_m, options);
}

double nguyenWeight(const SensorNoiseModel& noise_model, double z_m, double theta_rad)
{
  const double ratio = noise_model.axial_constant_m / noise_model.axialSigma_m(z_m, theta_rad);
  return ratio * ratio;
}

cv::Mat observationWeights(const Frame& frame, const cv::Mat& normals, const cv::Mat& edge_distance_px,
                           const ObservationWeightOptions& options)
{
  base::checked(options);
  return options.model == WeightModel::NGUYEN ? nguyenWeights(frame, normals)
                                              : paperWeights(frame, normals, edge_distance_px, options);
}

}  // namespace object_modelling::rgbd
