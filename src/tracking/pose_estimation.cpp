#include "pose_estimation.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::tracking
{
namespace
{
constexpr double HUBER_SIGMAS = 1.345;
constexpr double CONVERGED_STEP = 1e-7;  // m and rad
constexpr double MIN_DEPTH_M = 0.05;

/// Both the point and the measurement come from a depth image.
double depthSigma_m(double z_m)
{
  return std::sqrt(2.0) * rgbd::axialSigma_m(z_m, 0);
}

bool isInlier(const Correspondence& correspondence, const Eigen::Vector3d& p_camera,
              const geometry::PinholeCamera& camera, const PoseEstimationOptions& options, double* squared_error_px)
{
  if (p_camera.z() < MIN_DEPTH_M)
    return false;
  *squared_error_px = (camera.project(p_camera) - correspondence.pixel).squaredNorm();
  if (*squared_error_px > options.max_reprojection_error_px * options.max_reprojection_error_px)
    return false;
  return std::isnan(correspondence.depth_m) ||
         std::abs(correspondence.depth_m - p_camera.z()) <= options.depth_gate_sigmas * depthSigma_m(p_camera.z());
}

int countInliers(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                 const Eigen::Isometry3d& T_camera_session, const PoseEstimationOptions& options)
{
  int count = 0;
  double error = 0;
  for (const Correspondence& correspondence : correspondences)
    count += isInlier(correspondence, T_camera_session * correspondence.p_session, camera, options, &error);
  return count;
}

double huberWeight(double residual_sigmas)
{
  const double size = std::abs(residual_sigmas);
  return size <= HUBER_SIGMAS ? 1.0 : HUBER_SIGMAS / size;
}

/// Weighted normal equations at a pose; the parameters are a small motion on the left of T_camera_session.
struct NormalEquations
{
  geometry::Matrix6d A = geometry::Matrix6d::Zero();
  geometry::Vector6d b = geometry::Vector6d::Zero();
  double weighted_error = 0;
  double weight_sum = 0;

  void add(const Eigen::Matrix<double, 1, 6>& jacobian, double residual, double sigma)
  {
    const double weight = huberWeight(residual / sigma);
    const double scale = weight / (sigma * sigma);
    A.noalias() += scale * jacobian.transpose() * jacobian;
    b.noalias() -= scale * residual * jacobian.transpose();
    weighted_error += scale * residual * residual;
    weight_sum += weight;
  }
};

NormalEquations linearise(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                          const Eigen::Isometry3d& T_camera_session, const PoseEstimationOptions& options)
{
  NormalEquations equations;
  double error = 0;
  for (const Correspondence& correspondence : correspondences)
  {
    const Eigen::Vector3d p = T_camera_session * correspondence.p_session;
    if (!isInlier(correspondence, p, camera, options, &error))
      continue;
    const double inverse_z = 1 / p.z();
    Eigen::Matrix<double, 3, 6> dp;
    dp << Eigen::Matrix3d::Identity(),
        (Eigen::Matrix3d() << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0).finished();
    const Eigen::Vector2d residual = camera.project(p) - correspondence.pixel;
    const Eigen::Matrix<double, 1, 6> du = camera.fx * inverse_z * (dp.row(0) - p.x() * inverse_z * dp.row(2));
    const Eigen::Matrix<double, 1, 6> dv = camera.fy * inverse_z * (dp.row(1) - p.y() * inverse_z * dp.row(2));
    equations.add(du, residual.x(), options.pixel_sigma_px);
    equations.add(dv, residual.y(), options.pixel_sigma_px);
    if (!std::isnan(correspondence.depth_m))
      equations.add(dp.row(2), p.z() - correspondence.depth_m, depthSigma_m(p.z()));
  }
  return equations;
}

/// Covariance of a motion on the left of T_camera_session as one on the left of T_session_camera.
geometry::Matrix6d inSessionFrame(const geometry::Matrix6d& covariance, const Eigen::Isometry3d& T_session_camera)
{
  const Eigen::Matrix3d R = T_session_camera.linear();
  const Eigen::Vector3d t = T_session_camera.translation();
  Eigen::Matrix3d t_cross;
  t_cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  geometry::Matrix6d adjoint = geometry::Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = R;
  adjoint.topRightCorner<3, 3>() = t_cross * R;
  adjoint.bottomRightCorner<3, 3>() = R;
  return adjoint * covariance * adjoint.transpose();
}

int hypothesesNeeded(double inlier_ratio, const PoseEstimationOptions& options)
{
  const double clean = std::pow(inlier_ratio, 3);
  if (clean <= 1e-6)
    return options.max_hypotheses;
  if (clean >= 1 - 1e-6)
    return 1;
  const double needed = std::log(1 - options.confidence_ratio) / std::log(1 - clean);
  return static_cast<int>(std::min<double>(options.max_hypotheses, std::ceil(needed)));
}
}  // namespace

PoseEstimate refinePose(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                        const Eigen::Isometry3d& T_session_camera_start, const PoseEstimationOptions& options)
{
  PoseEstimate estimate;
  Eigen::Isometry3d T_camera_session = T_session_camera_start.inverse();
  NormalEquations equations;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration)
  {
    equations = linearise(correspondences, camera, T_camera_session, options);
    const Eigen::LDLT<geometry::Matrix6d> solver(equations.A);
    if (equations.weight_sum < 6 || solver.info() != Eigen::Success || solver.rcond() < 1e-12)
      return estimate;
    const geometry::Vector6d step = solver.solve(equations.b);
    T_camera_session = geometry::normalised(geometry::isometryFromVector(step) * T_camera_session);
    if (step.cwiseAbs().maxCoeff() < CONVERGED_STEP)
      break;
  }
  double squared_sum = 0;
  estimate.inliers.assign(correspondences.size(), 0);
  for (std::size_t i = 0; i < correspondences.size(); ++i)
  {
    double error = 0;
    if (!isInlier(correspondences[i], T_camera_session * correspondences[i].p_session, camera, options, &error))
      continue;
    estimate.inliers[i] = 1;
    ++estimate.inlier_count;
    squared_sum += error;
  }
  if (estimate.inlier_count < 4)
    return estimate;
  equations = linearise(correspondences, camera, T_camera_session, options);
  const double variance = equations.weighted_error / std::max(1.0, equations.weight_sum - 6);
  estimate.valid = true;
  estimate.T_session_camera = T_camera_session.inverse();
  estimate.reprojection_rmse_px = std::sqrt(squared_sum / estimate.inlier_count);
  estimate.covariance = inSessionFrame(equations.A.inverse() * variance, estimate.T_session_camera);
  return estimate;
}

PoseEstimate estimatePose(const std::vector<Correspondence>& correspondences, const geometry::PinholeCamera& camera,
                          const Eigen::Isometry3d& T_session_camera_prior, std::uint64_t seed,
                          const PoseEstimationOptions& options)
{
  const std::size_t count = correspondences.size();
  if (count < 4)
    return {};
  std::vector<std::size_t> with_depth;
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isnan(correspondences[i].depth_m))
      with_depth.push_back(i);

  Eigen::Isometry3d T_best = T_session_camera_prior;
  int best_count = countInliers(correspondences, camera, T_best.inverse(), options);
  if (with_depth.size() >= 3)
  {
    std::mt19937_64 generator(seed);
    int needed = hypothesesNeeded(static_cast<double>(best_count) / static_cast<double>(count), options);
    for (int drawn = 0; drawn < needed; ++drawn)
    {
      Eigen::Matrix3Xd p_session(3, 3), p_camera(3, 3);
      for (int k = 0; k < 3; ++k)
      {
        const Correspondence& drawn_one = correspondences[with_depth[generator() % with_depth.size()]];
        p_session.col(k) = drawn_one.p_session;
        p_camera.col(k) = camera.unproject(drawn_one.pixel.x(), drawn_one.pixel.y(), drawn_one.depth_m);
      }
      Eigen::Isometry3d T_session_camera;
      if (!geometry::rigidTransformFromPoints(p_session, p_camera, &T_session_camera))
        continue;
      const int inliers = countInliers(correspondences, camera, T_session_camera.inverse(), options);
      if (inliers <= best_count)
        continue;
      best_count = inliers;
      T_best = T_session_camera;
      needed = hypothesesNeeded(static_cast<double>(inliers) / static_cast<double>(count), options);
    }
  }
  // Three noisy depths place the camera roughly: a wider gate first, so that the least squares sees most of the
  // inliers.
  PoseEstimationOptions wide = options;
  wide.max_reprojection_error_px *= 2;
  wide.max_iterations = 3;
  const PoseEstimate rough = refinePose(correspondences, camera, T_best, wide);
  return refinePose(correspondences, camera, rough.valid ? rough.T_session_camera : T_best, options);
}

}  // namespace object_modelling::tracking
