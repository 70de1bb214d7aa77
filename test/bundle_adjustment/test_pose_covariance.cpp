#include "pose_covariance.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "support/synthetic_bundle.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
constexpr double SIGMA_PX = 0.5, LOSS_WIDTH_SIGMAS = 2;
constexpr int FIXED = 1;

struct Bundle
{
  explicit Bundle(double depth_sigma_scale = 1, double missing_depth_ratio = 0.2)
  {
    test_support::SyntheticBundleOptions options;
    options.camera_count = 4;
    options.step_rad = 0.3;
    options.landmark_count = 60;
    options.pixel_sigma_px = SIGMA_PX;
    options.depth_sigma_scale = depth_sigma_scale;
    options.missing_depth_ratio = missing_depth_ratio;
    keyframes = test_support::makeSyntheticBundle(options).keyframes;
    for (const rgbd::Keyframe& keyframe : keyframes)
      state.T_session_camera.push_back(keyframe.T_session_camera);
    state.map = placeLandmarks(trackedSights(keyframes, SIGMA_PX, false), keyframes, state.T_session_camera, 2);
  }
  std::vector<geometry::Matrix6d> covariances() const
  {
    return poseCovariances(keyframes, FIXED, LOSS_WIDTH_SIGMAS, state);
  }
  std::vector<rgbd::Keyframe> keyframes;
  BundleState state;
};

/// Pixel and depth of a sight minus those of the landmark, in sigmas; depth 0 where there is none.
Eigen::Vector3d residual(const Bundle& bundle, const Sight& sight, const Eigen::Isometry3d& T_session_camera,
                         const Eigen::Vector3d& landmark)
{
  const rgbd::Frame& frame = bundle.keyframes[sight.keyframe].frame;
  const Eigen::Vector3d p = T_session_camera.inverse() * landmark;
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head<2>() = (frame.camera.project(p) - sight.pixel) / sight.sigma_px;
  if (sight.depth_m > 0)
    result.z() = (p.z() - sight.depth_m) / frame.noise_model.axialSigma_m(sight.depth_m, 0);
  return result;
}

/// All at once and by differences: normal equations of every pose and landmark, inverted as a whole.
Eigen::MatrixXd denseCovariance(const Bundle& bundle)
{
  const auto cameras = static_cast<Eigen::Index>(bundle.keyframes.size());
  const Eigen::Index size = 6 * cameras + 3 * static_cast<Eigen::Index>(bundle.state.map.landmarks.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  double squares = 0, weights = 0;
  for (const Sight& sight : bundle.state.map.sights)
  {
    const Eigen::Isometry3d& T = bundle.state.T_session_camera[sight.keyframe];
    const Eigen::Vector3d& landmark = bundle.state.map.landmarks[sight.landmark];
    const Eigen::Vector3d r = residual(bundle, sight, T, landmark);
    Eigen::Matrix<double, 3, 9> J;
    constexpr double STEP = 1e-6;
    for (int i = 0; i < 9; ++i)
    {
      const auto moved = [&](double step)
      {
        Eigen::Matrix<double, 9, 1> delta = Eigen::Matrix<double, 9, 1>::Zero();
        delta[i] = step;
        return residual(bundle, sight, geometry::isometryFromVector(delta.head<6>()) * T, landmark + delta.tail<3>());
      };
      J.col(i) = (moved(STEP) - moved(-STEP)) / (2 * STEP);
    }
    // Cauchy: pixel and depth each for itself.
    const double pixel_weight = 1 / (1 + r.head<2>().squaredNorm() / (LOSS_WIDTH_SIGMAS * LOSS_WIDTH_SIGMAS));
    const double depth_weight =
        sight.depth_m > 0 ? 1 / (1 + r.z() * r.z() / (LOSS_WIDTH_SIGMAS * LOSS_WIDTH_SIGMAS)) : 0;
    const Eigen::Vector3d weight(pixel_weight, pixel_weight, depth_weight);
    squares += weight.dot(r.cwiseAbs2());
    weights += weight.sum();
    const Eigen::Matrix<double, 9, 9> block = J.transpose() * weight.asDiagonal() * J;
    const Eigen::Index at_camera = 6 * sight.keyframe, at_landmark = 6 * cameras + 3 * sight.landmark;
    normal.block<6, 6>(at_camera, at_camera) += block.topLeftCorner<6, 6>();
    normal.block<6, 3>(at_camera, at_landmark) += block.topRightCorner<6, 3>();
    normal.block<3, 6>(at_landmark, at_camera) += block.bottomLeftCorner<3, 6>();
    normal.block<3, 3>(at_landmark, at_landmark) += block.bottomRightCorner<3, 3>();
  }
  // As good as known.
  normal.block<6, 6>(6 * FIXED, 6 * FIXED) += 1e16 * geometry::Matrix6d::Identity();
  const double freedom = weights - static_cast<double>(size - 6);
  return squares / freedom * normal.inverse();
}

TEST(PoseCovariance, IsThatOfAllPosesAndLandmarksTogether)
{
  for (const double missing_depth_ratio : { 0.0, 0.5 })
  {
    const Bundle bundle(1, missing_depth_ratio);
    ASSERT_GT(bundle.state.map.landmarks.size(), 10u);
    const Eigen::MatrixXd dense = denseCovariance(bundle);
    const std::vector<geometry::Matrix6d> found = bundle.covariances();
    for (int k = 0; k < static_cast<int>(found.size()); ++k)
    {
      if (k == FIXED)
        continue;
      const geometry::Matrix6d expected = dense.block<6, 6>(6 * k, 6 * k);
      // Each entry against the sigmas of its row and column.
      const geometry::Vector6d sigmas = expected.diagonal().cwiseSqrt();
      const geometry::Matrix6d off = (found[k] - expected).array() / (sigmas * sigmas.transpose()).array();
      EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-3) << k << "\n" << found[k] << "\n\n" << expected;
      EXPECT_TRUE(found[k].isApprox(found[k].transpose(), 1e-12));
    }
  }
}

TEST(PoseCovariance, GrowsWithTheResiduals)
{
  const Bundle good(0.3), bad(3);
  const double ratio = bad.covariances()[3].trace() / good.covariances()[3].trace();
  EXPECT_GT(ratio, 2);
}

TEST(PoseCovariance, IsZeroWhereNothingIsKnown)
{
  Bundle bundle;
  EXPECT_TRUE(bundle.covariances()[FIXED].isZero(0));
  // A keyframe more, without sights.
  bundle.keyframes.push_back(bundle.keyframes.back());
  bundle.state.T_session_camera.push_back(bundle.state.T_session_camera.back());
  const std::vector<geometry::Matrix6d> with_blind = bundle.covariances();
  ASSERT_EQ(with_blind.size(), 5u);
  EXPECT_TRUE(with_blind[4].isZero(0));
  EXPECT_FALSE(with_blind[3].isZero(0));
  // One landmark does not hold six directions; of none there is nothing to invert.
  Bundle one;
  const auto others = std::find_if(one.state.map.sights.begin(), one.state.map.sights.end(),
                                   [](const Sight& sight) { return sight.landmark > 0; });
  one.state.map.sights.erase(others, one.state.map.sights.end());
  one.state.map.landmarks.resize(1);
  for (const geometry::Matrix6d& covariance : one.covariances())
    EXPECT_TRUE(covariance.isZero(0));
  one.state.map = {};
  for (const geometry::Matrix6d& covariance : one.covariances())
    EXPECT_TRUE(covariance.isZero(0));
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
