#include "cost_functions.h"

#include <algorithm>
#include <memory>

#include <ceres/ceres.h>
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
LinearizedCamera makeCamera()
{
  geometry::PinholeCamera camera;
  camera.fx = 531;
  camera.fy = 527;
  camera.cx = 322;
  camera.cy = 237;
  geometry::Vector6d pose;
  pose << 0.3, -0.2, 0.1, 0.4, -0.7, 0.2;
  return { camera, geometry::isometryFromVector(pose) };
}

/// Landmark 0.8 m in front of the camera, a little off its axis, in the session frame.
Eigen::Vector3d makeLandmark(const LinearizedCamera& camera)
{
  return camera.T_camera_session.inverse() * Eigen::Vector3d(0.1, -0.05, 0.8);
}

void expectRightDerivatives(const ceres::CostFunction& cost, const Eigen::Vector3d& landmark,
                            const Eigen::Vector4d& correction)
{
  std::vector<geometry::Vector6d> motions(3, geometry::Vector6d::Zero());
  motions[1] << 0.01, -0.02, 0.03, 0.2, -0.1, 0.3;
  motions[2] << 0, 0, 0, 1e-8, 0, -1e-8;
  ceres::NumericDiffOptions numeric;
#if CERES_VERSION_MAJOR < 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR < 1)
  const std::vector<const ceres::LocalParameterization*>* manifolds = nullptr;
#else
  const std::vector<const ceres::Manifold*>* manifolds = nullptr;
#endif
  ceres::GradientChecker checker(&cost, manifolds, numeric);
  for (const geometry::Vector6d& motion : motions)
  {
    const Eigen::Vector2d offset_px(0.3, -0.7);
    const double* parameters[5] = { motion.data(), landmark.data(), offset_px.data(), correction.data(),
                                    &correction[1] };
    ceres::GradientChecker::ProbeResults results;
    checker.Probe(parameters, 1e-6, &results);
    ASSERT_EQ(results.jacobians.size(), cost.parameter_block_sizes().size());
    // By blocks, not by entries as Probe: what is almost zero drowns in rounding.
    for (std::size_t i = 0; i < results.jacobians.size(); ++i)
    {
      const double tolerance = 1e-6 * std::max(1.0, results.numeric_jacobians[i].norm());
      EXPECT_LT((results.jacobians[i] - results.numeric_jacobians[i]).norm(), tolerance) << results.error_log;
    }
  }
}

TEST(CostFunctions, haveRightDerivatives)
{
  const LinearizedCamera camera = makeCamera();
  expectRightDerivatives(ReprojectionCost(&camera, { 350, 220 }, 0.5), makeLandmark(camera), { 0.02, -0.03, 1.5, -2 });
  expectRightDerivatives(DepthCost(&camera, 0.78, { 0.002, -0.001 }, 0.0015), makeLandmark(camera),
                         { 0.02, -0.004, 0, 0 });
}

TEST(CostFunctions, countInSigmas)
{
  const LinearizedCamera camera = makeCamera();
  const Eigen::Vector3d landmark = makeLandmark(camera);
  const geometry::Vector6d motion = geometry::Vector6d::Zero();
  Eigen::Vector2d offset_px(0, 0);
  const Eigen::Vector4d none = Eigen::Vector4d::Zero();
  const double* parameters[5] = { motion.data(), landmark.data(), offset_px.data(), none.data(), none.data() };
  const Eigen::Vector2d pixel(531 * 0.1 / 0.8 + 322, 527 * -0.05 / 0.8 + 237);
  double residuals[2];
  ASSERT_TRUE(ReprojectionCost(&camera, pixel - Eigen::Vector2d(1, -2), 0.5).Evaluate(parameters, residuals, nullptr));
  EXPECT_NEAR(residuals[0], 2, 1e-9);
  EXPECT_NEAR(residuals[1], -4, 1e-9);
  const DepthCost depth_cost(&camera, 0.803, { 0.002, -0.001 }, 0.001);
  ASSERT_TRUE(depth_cost.Evaluate(parameters, residuals, nullptr));
  EXPECT_NEAR(residuals[0], -3, 1e-9);
  // Colour is shifted to the right and down: the landmark's depth is to be read further left and up.
  offset_px = { 1, 2 };
  ASSERT_TRUE(ReprojectionCost(&camera, pixel + offset_px, 0.5).Evaluate(parameters, residuals, nullptr));
  EXPECT_NEAR(residuals[0], 0, 1e-9);
  EXPECT_NEAR(residuals[1], 0, 1e-9);
  ASSERT_TRUE(depth_cost.Evaluate(parameters, residuals, nullptr));
  EXPECT_NEAR(residuals[0], (0.8 - (0.803 - 1 * 0.002 - 2 * -0.001)) / 0.001, 1e-9);
}

TEST(CostFunctions, takeWhatTheSensorIsOffBy)
{
  const LinearizedCamera camera = makeCamera();
  const Eigen::Vector3d landmark = makeLandmark(camera);
  const geometry::Vector6d motion = geometry::Vector6d::Zero();
  const Eigen::Vector2d offset_px(0, 0);
  const Eigen::Vector4d intrinsics(0.01, -0.02, 3, 4);
  const Eigen::Vector2d depth(0.01, -0.002);
  double residuals[2];
  const Eigen::Vector2d pixel(531 * 1.01 * 0.1 / 0.8 + 325, 527 * 0.98 * -0.05 / 0.8 + 241);
  const double* of_pixel[4] = { motion.data(), landmark.data(), offset_px.data(), intrinsics.data() };
  ASSERT_TRUE(ReprojectionCost(&camera, pixel, 0.5).Evaluate(of_pixel, residuals, nullptr));
  EXPECT_NEAR(residuals[0], 0, 1e-9);
  EXPECT_NEAR(residuals[1], 0, 1e-9);
  const double* of_depth[5] = { motion.data(), landmark.data(), offset_px.data(), &depth[0], &depth[1] };
  ASSERT_TRUE(DepthCost(&camera, 0.802 / 1.01, { 0, 0 }, 0.001).Evaluate(of_depth, residuals, nullptr));
  EXPECT_NEAR(residuals[0], 0, 1e-9);
}

TEST(CostFunctions, surfacesMayLeaveADirectionFree)
{
  const LinearizedCamera camera = makeCamera();
  geometry::Matrix6d information = 1e4 * geometry::Matrix6d::Identity();
  const geometry::Vector6d free = (geometry::Vector6d() << 1, 2, 0, 0, 0, 0).finished().normalized();
  information -= 1e4 * free * free.transpose();
  SurfaceLink link;
  link.information = information;
  link.by_color_offset(1, 0) = 0.01;
  link.color_offset_px = { 0.5, 0 };
  const Eigen::Vector2d offset_px(0.5, 0), further_px(1.5, 0);
  const std::unique_ptr<ceres::CostFunction> cost(surfaceCost(camera, camera, link));
  const geometry::Vector6d none = geometry::Vector6d::Zero(), along = 0.01 * free;
  const geometry::Vector6d across = (geometry::Vector6d() << -0.02, 0.01, 0, 0, 0, 0).finished();
  geometry::Vector6d residuals;
  const double* slid[3] = { along.data(), none.data(), offset_px.data() };
  ASSERT_TRUE(cost->Evaluate(slid, residuals.data(), nullptr));
  EXPECT_LT(residuals.norm(), 1e-6);
  const double* off[3] = { across.data(), none.data(), offset_px.data() };
  ASSERT_TRUE(cost->Evaluate(off, residuals.data(), nullptr));
  EXPECT_NEAR(residuals.norm(), 100 * across.norm(), 1e-6);
  const double* moved[3] = { across.data(), none.data(), further_px.data() };
  ASSERT_TRUE(cost->Evaluate(moved, residuals.data(), nullptr));
  const geometry::Vector6d left = across - 0.01 * geometry::Vector6d::Unit(1);
  EXPECT_NEAR(residuals.norm(), 100 * (left - free * free.dot(left)).norm(), 1e-6);
}

TEST(CostFunctions, countALandmarkBehindTheCameraAsGrossOutlier)
{
  const LinearizedCamera camera = makeCamera();
  const Eigen::Vector3d behind = camera.T_camera_session.inverse() * Eigen::Vector3d(0.1, 0, -0.5);
  const geometry::Vector6d motion = geometry::Vector6d::Zero();
  const double offset_px[2] = { 0, 0 };
  const double correction[4] = { 0, 0, 0, 0 };
  const double* parameters[4] = { motion.data(), behind.data(), offset_px, correction };
  double residuals[2], by_motion[12], by_point[6], by_offset[4], by_correction[8];
  double* jacobians[4] = { by_motion, by_point, by_offset, by_correction };
  ASSERT_TRUE(ReprojectionCost(&camera, { 0, 0 }, 1).Evaluate(parameters, residuals, jacobians));
  EXPECT_GT(residuals[0], 100);
  for (double value : by_motion)
    EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
