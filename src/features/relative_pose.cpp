#include "object_modelling/features/relative_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "object_modelling/base/ransac.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/geometry/so3.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::features
{
namespace
{
// Shorter triples hardly constrain rotation.
constexpr double MIN_TRIPLE_EDGE_M = 0.01;
constexpr int REFINEMENTS = 8;
constexpr double CONFIDENCE = 0.999;
constexpr double SAMPLES_FACTOR = 3;  // of triples of inliers alone, those of near or noisy points still fail

/// Point pairs with the covariance of each end, and a cheap scalar gate for RANSAC.
struct Prepared
{
  std::vector<Eigen::Matrix3d> C_a, C_b;
  std::vector<double> gate_squared_m2;
};

Prepared prepare(const std::vector<PointPair>& pairs, const rgbd::Frame& frame_a, const rgbd::Frame& frame_b,
                 double gate_sigmas)
{
  Prepared result;
  for (const PointPair& pair : pairs)
  {
    result.C_a.push_back(backProjectionCovariance(pair.p_a, frame_a, pair.sigma_a_px));
    result.C_b.push_back(backProjectionCovariance(pair.p_b, frame_b, pair.sigma_b_px));
    // A triple of noisy points predicts the others worse than the noise alone: twice the variance.
    result.gate_squared_m2.push_back(2 * gate_sigmas * gate_sigmas *
                                     (result.C_a.back().trace() + result.C_b.back().trace()) / 3);
  }
  return result;
}

double mahalanobisSquared(const PointPair& pair, const Eigen::Matrix3d& C_a, const Eigen::Matrix3d& C_b,
                          const Eigen::Isometry3d& T_a_b)
{
  const Eigen::Vector3d error = pair.p_a - T_a_b * pair.p_b;
  const Eigen::Matrix3d C = C_a + T_a_b.linear() * C_b * T_a_b.linear().transpose();
  return error.dot(C.inverse() * error);
}

std::vector<int> inliersOf(const Eigen::Isometry3d& T_a_b, const std::vector<PointPair>& pairs,
                           const Prepared& prepared, double gate_sigmas)
{
  std::vector<int> inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (mahalanobisSquared(pairs[i], prepared.C_a[i], prepared.C_b[i], T_a_b) < gate_sigmas * gate_sigmas)
      inliers.push_back(static_cast<int>(i));
  return inliers;
}

/// A rigid motion keeps lengths: rejects most wrong triples before any pose is computed.
bool lengthsAgree(const PointPair& first, const PointPair& second, double gate_squared_m2)
{
  const double length_a = (first.p_a - second.p_a).norm(), length_b = (first.p_b - second.p_b).norm();
  const double difference = length_a - length_b;
  return std::min(length_a, length_b) > MIN_TRIPLE_EDGE_M && difference * difference < gate_squared_m2;
}

std::optional<Eigen::Isometry3d> poseOfTriple(const std::vector<PointPair>& pairs, const std::array<int, 3>& triple)
{
  Eigen::Matrix3Xd p_a(3, 3), p_b(3, 3);
  for (int i = 0; i < 3; ++i)
  {
    p_a.col(i) = pairs[triple[i]].p_a;
    p_b.col(i) = pairs[triple[i]].p_b;
  }
  const Eigen::Vector3d across = (p_a.col(1) - p_a.col(0)).cross(p_a.col(2) - p_a.col(0));
  Eigen::Isometry3d T_a_b;
  if (across.norm() < MIN_TRIPLE_EDGE_M * MIN_TRIPLE_EDGE_M || !geometry::rigidTransformFromPoints(p_a, p_b, &T_a_b))
    return std::nullopt;
  return T_a_b;
}

int countInliers(const std::vector<PointPair>& pairs, const Prepared& prepared, const Eigen::Isometry3d& T_a_b)
{
  int count = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if ((pairs[i].p_a - T_a_b * pairs[i].p_b).squaredNorm() < prepared.gate_squared_m2[i])
      ++count;
  return count;
}

/// One step of iteratively reweighted (Cauchy) Gauss-Newton; a small motion on the left of T_a_b.
void refineStep(const std::vector<PointPair>& pairs, const Prepared& prepared, double gate_sigmas,
                Eigen::Isometry3d* T_a_b)
{
  geometry::Matrix6d A = geometry::Matrix6d::Zero();
  geometry::Vector6d b = geometry::Vector6d::Zero();
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    const Eigen::Vector3d moved = *T_a_b * pairs[i].p_b;
    const Eigen::Vector3d error = pairs[i].p_a - moved;
    const Eigen::Matrix3d information =
        (prepared.C_a[i] + T_a_b->linear() * prepared.C_b[i] * T_a_b->linear().transpose()).inverse();
    const double squared = error.dot(information * error);
    if (squared > 4 * gate_sigmas * gate_sigmas)
      continue;
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -geometry::crossMatrix(moved);
    const double weight = 1 / (1 + squared / 4);
    A += weight * J.transpose() * information * J;
    b += weight * J.transpose() * information * error;
  }
  if (const std::optional<geometry::Vector6d> step = geometry::solveWellPosed(A, b))
    *T_a_b = geometry::normalized(geometry::isometryFromVector(*step) * *T_a_b);
}

}  // namespace

Eigen::Matrix3d backProjectionCovariance(const Eigen::Vector3d& p_camera, const rgbd::Frame& frame, double sigma_px)
{
  const double z = p_camera.z();
  const Eigen::Vector3d along = p_camera / z * frame.noise_model.axialSigma_m(z, 0);
  const double lateral_x = z * sigma_px / frame.camera.fx, lateral_y = z * sigma_px / frame.camera.fy;
  Eigen::Matrix3d C = along * along.transpose();
  C(0, 0) += lateral_x * lateral_x;
  C(1, 1) += lateral_y * lateral_y;
  return C;
}

RelativePose estimateRelativePose(const std::vector<PointPair>& pairs, const rgbd::Frame& frame_a,
                                  const rgbd::Frame& frame_b, const RelativePoseOptions& options)
{
  RelativePose result;
  const int count = static_cast<int>(pairs.size());
  if (count < 4)
    return result;
  const Prepared prepared = prepare(pairs, frame_a, frame_b, options.gate_sigmas);
  const auto agree = [&](int i, int j)
  { return lengthsAgree(pairs[i], pairs[j], prepared.gate_squared_m2[i] + prepared.gate_squared_m2[j]); };
  const auto solve = [&](const std::array<int, 3>& triple) -> std::optional<Eigen::Isometry3d>
  {
    const auto& [i, j, k] = triple;
    if (!agree(i, j) || !agree(j, k) || !agree(i, k))
      return std::nullopt;
    return poseOfTriple(pairs, triple);
  };
  const auto inlier_ratio = [&](const Eigen::Isometry3d& T_a_b)
  {
    const int inliers = countInliers(pairs, prepared, T_a_b);
    return inliers > 3 ? static_cast<double>(inliers) / count : 0;  // no other pair agrees with the triple
  };
  base::RansacOptions ransac_options;
  ransac_options.max_samples = options.max_iterations;
  ransac_options.confidence_ratio = CONFIDENCE;
  ransac_options.samples_factor = SAMPLES_FACTOR;
  ransac_options.seed = options.seed;
  ransac_options.draw = base::IndexDraw::LIBRARY_DISTRIBUTION;  // models of given recordings stay as they are
  const auto best = base::ransac<3, Eigen::Isometry3d>(pairs.size(), ransac_options, solve, inlier_ratio);
  if (!best)
    return result;
  result.found = true;
  result.T_a_b = best->model;
  for (int i = 0; i < REFINEMENTS; ++i)
    refineStep(pairs, prepared, options.gate_sigmas, &result.T_a_b);
  result.inliers = inliersOf(result.T_a_b, pairs, prepared, options.gate_sigmas);
  return result;
}

std::vector<int> inliersOf(const Eigen::Isometry3d& T_a_b, const std::vector<PointPair>& pairs,
                           const rgbd::Frame& frame_a, const rgbd::Frame& frame_b, double gate_sigmas)
{
  return inliersOf(T_a_b, pairs, prepare(pairs, frame_a, frame_b, gate_sigmas), gate_sigmas);
}

}  // namespace object_modelling::features
