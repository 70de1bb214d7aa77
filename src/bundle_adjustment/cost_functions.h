#pragma once

#include <array>
#include <memory>
#include <utility>

#include <ceres/sized_cost_function.h>
#include <Eigen/Geometry>

#include "object_modelling/geometry/pinhole_camera.h"
#include "object_modelling/geometry/transform.h"
#include "surface_links.h"

namespace object_modelling::bundle_adjustment
{
/// A keyframe's part of a residual. The optimised block of 6 is a motion xi = (t, r) on the left of this
/// pose: T_camera_session(xi) = [R(r) | t] * T_camera_session. It starts at 0 and stays small, so that rotation vectors
/// never come near their singularity and no manifold is needed (its Ceres interface changed with 2.1).
struct LinearizedCamera
{
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  Eigen::Isometry3d T_camera_session = Eigen::Isometry3d::Identity();

  LinearizedCamera() = default;
  LinearizedCamera(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& T_session_camera)
      : fx(camera.fx), fy(camera.fy), cx(camera.cx), cy(camera.cy), T_camera_session(T_session_camera.inverse())
  {
  }

  /// Point in the camera after the motion, and its derivatives where asked for (null: not).
  Eigen::Vector3d transform(const double* xi, const double* p_session, Eigen::Matrix<double, 3, 6>* by_motion,
                            Eigen::Matrix3d* by_point) const;
};

/// Pixel of a landmark minus its observation, in sigmas. Blocks: motion (6), landmark in the session frame (3), offset
/// of the colour image against the depth image (2, px), correction of the intrinsics (4: share that fx, fy grow by;
/// shift of cx, cy, px).
class ReprojectionCost : public ceres::SizedCostFunction<2, 6, 3, 2, 4>
{
public:
  /// `camera` must outlive the cost.
  ReprojectionCost(const LinearizedCamera* camera, const Eigen::Vector2d& pixel, double sigma_px)
      : camera_(camera), pixel_(pixel), sigma_px_(sigma_px)
  {
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

private:
  const LinearizedCamera* camera_;
  Eigen::Vector2d pixel_;
  double sigma_px_;
};

/// Depth of a landmark minus its observation, in sigmas. Blocks: motion, landmark, offset as above; share that depth
/// grows by (1); what is added to it (1, m). The second residual is always 0: Ceres has its Schur elimination compiled
/// for residual blocks of 2 rows; blocks that differ cost a fifth of the whole time more.
class DepthCost : public ceres::SizedCostFunction<2, 6, 3, 2, 1, 1>
{
public:
  /// The depth was read at the landmark's pixel in the colour image. Where the images are offset that is beside it by
  /// the offset, and `slope_m_px` is the gradient of depth there, metres per pixel.
  DepthCost(const LinearizedCamera* camera, double depth_m, const Eigen::Vector2d& slope_m_px, double sigma_m)
      : camera_(camera), depth_m_(depth_m), slope_m_px_(slope_m_px), sigma_m_(sigma_m)
  {
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;
  /// By the share that depth is measured too large.
  double sigmasByDistortion() const { return depth_m_ / sigma_m_; }

private:
  const LinearizedCamera* camera_;
  double depth_m_;
  Eigen::Vector2d slope_m_px_;
  double sigma_m_;
};

/// The same where the depth images are distorted. Four blocks more: what depth is measured too large at the knots round
/// the pixel, as shares of it (1 each).
class DistortedDepthCost : public ceres::SizedCostFunction<2, 6, 3, 2, 1, 1, 1, 1, 1, 1>
{
public:
  DistortedDepthCost(std::unique_ptr<DepthCost> undistorted, const std::array<double, 4>& shares)
      : undistorted_(std::move(undistorted)), shares_(shares)
  {
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override;

private:
  std::unique_ptr<DepthCost> undistorted_;
  std::array<double, 4> shares_;
};

/// Relative pose of two cameras minus that of the link, in sigmas. Blocks: motion of a (6), motion of b (6), offset of
/// the colour images (2, px). The caller owns the result.
ceres::CostFunction* surfaceCost(const LinearizedCamera& a, const LinearizedCamera& b, const SurfaceLink& link);

}  // namespace object_modelling::bundle_adjustment
