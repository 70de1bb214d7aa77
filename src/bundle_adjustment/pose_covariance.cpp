#include "pose_covariance.h"

#include <array>

#include <Eigen/Cholesky>

#include "cost_functions.h"
#include "sensor_blocks.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
/// Normal equations of one sight, residuals weighted as the Cauchy loss does at the solution.
struct SightEquations
{
  int unknown = -1;  ///< row of its pose among the free poses; -1 if that is fixed
  geometry::Matrix6d motion = geometry::Matrix6d::Zero();
  Eigen::Matrix<double, 6, 3> cross = Eigen::Matrix<double, 6, 3>::Zero();
  Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
};

struct ResidualSum
{
  double squared = 0;
  double weight = 0;  ///< number of scalar residuals, each counted by its weight
};

/// `dimension`: how many of the cost's two residuals are measurements.
template <typename Cost>
void accumulate(const Cost& cost, const double* landmark, const std::array<const double*, 3>& sensor, double loss_width,
                int dimension, SightEquations* equations, ResidualSum* sum)
{
  const geometry::Vector6d motion = geometry::Vector6d::Zero();
  const double* parameters[5] = { motion.data(), landmark, sensor[0], sensor[1], sensor[2] };
  Eigen::Vector2d residual;
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> by_motion;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_point;
  double* jacobians[5] = { by_motion.data(), by_point.data(), nullptr, nullptr, nullptr };
  if (!cost.Evaluate(parameters, residual.data(), jacobians))
    return;
  const double weight = 1 / (1 + residual.squaredNorm() / (loss_width * loss_width));
  equations->motion += weight * by_motion.transpose() * by_motion;
  equations->cross += weight * by_motion.transpose() * by_point;
  equations->point += weight * by_point.transpose() * by_point;
  sum->squared += weight * residual.squaredNorm();
  sum->weight += weight * dimension;
}

/// Motion on the left of T_camera_session -> motion on the left of T_session_camera (adjoint; the sign cancels).
geometry::Matrix6d inSession(const geometry::Matrix6d& covariance_camera, const Eigen::Isometry3d& T_session_camera)
{
  const geometry::Matrix6d adjoint = geometry::adjoint(T_session_camera);
  return adjoint * covariance_camera * adjoint.transpose();
}

/// Takes the landmark out of the equations of the poses that see it (Schur complement).
void eliminate(const std::vector<SightEquations>& sights, Eigen::MatrixXd* reduced)
{
  Eigen::Matrix3d point = Eigen::Matrix3d::Zero();
  for (const SightEquations& sight : sights)
    point += sight.point;
  const Eigen::LLT<Eigen::Matrix3d> llt(point);
  if (llt.info() != Eigen::Success)
    return;
  const Eigen::Matrix3d inverse = llt.solve(Eigen::Matrix3d::Identity());
  for (const SightEquations& a : sights)
  {
    if (a.unknown < 0)
      continue;
    reduced->block<6, 6>(6 * a.unknown, 6 * a.unknown) += a.motion;
    const Eigen::Matrix<double, 6, 3> gain = a.cross * inverse;
    for (const SightEquations& b : sights)
      if (b.unknown >= 0)
        reduced->block<6, 6>(6 * a.unknown, 6 * b.unknown) -= gain * b.cross.transpose();
  }
}

}  // namespace

std::vector<geometry::Matrix6d> poseCovariances(const std::vector<rgbd::Keyframe>& keyframes, int fixed_keyframe,
                                                double loss_width_sigmas, const BundleState& state)
{
  std::vector<LinearizedCamera> cameras;
  cameras.reserve(keyframes.size());
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    cameras.emplace_back(keyframes[k].frame.camera, state.T_session_camera[k]);

  std::vector<int> unknown(keyframes.size(), -1);
  int unknown_count = 0;
  for (const Sight& sight : state.map.sights)
    if (sight.keyframe != fixed_keyframe && unknown[sight.keyframe] < 0)
      unknown[sight.keyframe] = unknown_count++;

  const SensorBlocks sensor(state);
  Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(6 * unknown_count, 6 * unknown_count);
  ResidualSum sum;
  std::vector<SightEquations> of_landmark;
  const std::vector<Sight>& sights = state.map.sights;
  for (std::size_t i = 0; i < sights.size(); ++i)
  {
    const Sight& sight = sights[i];
    const double* landmark = state.map.landmarks[sight.landmark].data();
    const double* offset = sensor.color_offset_px.data();
    SightEquations equations;
    equations.unknown = unknown[sight.keyframe];
    accumulate(ReprojectionCost(&cameras[sight.keyframe], sight.pixel, sight.sigma_px), landmark,
               { offset, sensor.intrinsics.data(), nullptr }, loss_width_sigmas, 2, &equations, &sum);
    if (sight.depth_m > 0)
    {
      const double sigma_m = keyframes[sight.keyframe].frame.noise_model.axialSigma_m(sight.depth_m, 0);
      accumulate(DepthCost(&cameras[sight.keyframe], sight.depth_m, sight.depth_slope_m_px, sigma_m), landmark,
                 { offset, &sensor.depth_growth, &sensor.depth_offset_m }, loss_width_sigmas, 1, &equations, &sum);
    }
    of_landmark.push_back(equations);
    if (i + 1 == sights.size() || sights[i + 1].landmark != sight.landmark)
    {
      eliminate(of_landmark, &reduced);
      of_landmark.clear();
    }
  }

  std::vector<geometry::Matrix6d> result(keyframes.size(), geometry::Matrix6d::Zero());
  const Eigen::LLT<Eigen::MatrixXd> llt(reduced);
  const double freedom = sum.weight - 6.0 * unknown_count - 3.0 * static_cast<double>(state.map.landmarks.size());
  if (unknown_count == 0 || llt.info() != Eigen::Success || !(freedom > 0))
    return result;
  const Eigen::MatrixXd covariance = llt.solve(Eigen::MatrixXd::Identity(reduced.rows(), reduced.cols()));
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    if (unknown[k] < 0)
      continue;
    const geometry::Matrix6d block = covariance.block<6, 6>(6 * unknown[k], 6 * unknown[k]);
    result[k] = sum.squared / freedom * inSession(0.5 * (block + block.transpose()), state.T_session_camera[k]);
  }
  return result;
}

}  // namespace object_modelling::bundle_adjustment
