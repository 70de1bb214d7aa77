#include "object_modelling/bundle_adjustment/bundle_adjustment.h"

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "object_modelling/rgbd/sensor_noise_model.h"
#include "support/pose_errors.h"
#include "support/synthetic_bundle.h"
#include "support/violations.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
using test_support::SyntheticBundleOptions;

/// Exact poses; observations with the noise asked for.
std::vector<rgbd::Keyframe> observedLandmarks(const SyntheticBundleOptions& options = {})
{
  return test_support::makeSyntheticBundle(options).keyframes;
}

BundleAdjustmentOptions withoutLinks()
{
  BundleAdjustmentOptions options;
  options.link_keyframes = false;
  return options;
}

BundleAdjustmentResult adjust(const std::vector<rgbd::Keyframe>& keyframes,
                              const BundleAdjustmentOptions& options = withoutLinks())
{
  base::JobControl control;
  return adjustBundle(keyframes, options, control);
}

TEST(BundleAdjustment, recoversExactPosesFromASmallPerturbation)
{
  const std::vector<rgbd::Keyframe> truth = observedLandmarks();
  const BundleAdjustmentResult result = adjust(test_support::perturbed(truth, 0.005, 0.01));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const test_support::PoseError error = test_support::largestError(result.T_session_camera, truth);
  EXPECT_LT(error.translation_m, 2e-5);
  EXPECT_LT(error.rotation_rad, 3e-5);
  EXPECT_TRUE(result.left_out.empty());
  EXPECT_LT(result.final_cost, result.initial_cost);
}

TEST(BundleAdjustment, recoversExactPosesFromALargePerturbation)
{
  const std::vector<rgbd::Keyframe> truth = observedLandmarks();
  const BundleAdjustmentResult result = adjust(test_support::perturbed(truth, 0.06, 0.12));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const test_support::PoseError error = test_support::largestError(result.T_session_camera, truth);
  EXPECT_LT(error.translation_m, 2e-5);
  EXPECT_LT(error.rotation_rad, 3e-5);
}

TEST(BundleAdjustment, keepsTheFirstPoseBitForBit)
{
  std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(observedLandmarks(), 0.01, 0.02);
  const Eigen::Isometry3d T_other_session(Eigen::Translation3d(1, -2, 3) *
                                          Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 3).normalized()));
  for (rgbd::Keyframe& keyframe : keyframes)
    keyframe.T_session_camera = T_other_session * keyframe.T_session_camera;
  const BundleAdjustmentResult result = adjust(keyframes);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.T_session_camera[0].matrix(), keyframes[0].T_session_camera.matrix());
  EXPECT_TRUE(result.covariance[0].isZero());
}

/// As a sensor whose intrinsics and depth are off would deliver them.
std::vector<rgbd::Keyframe> mismeasured(std::vector<rgbd::Keyframe> keyframes, const rgbd::SensorCorrection& sensor)
{
  for (rgbd::Keyframe& keyframe : keyframes)
  {
    keyframe.frame.camera.fx /= sensor.focal_ratio.x();
    keyframe.frame.camera.fy /= sensor.focal_ratio.y();
    keyframe.frame.camera.cx -= sensor.principal_shift_px.x();
    keyframe.frame.camera.cy -= sensor.principal_shift_px.y();
    for (rgbd::Observation& observation : keyframe.observations)
    {
      const double distortion =
          rgbd::DistortionGrid::ratioAt(sensor.depth_distortion_ratio, observation.pixel.x(), observation.pixel.y(),
                                        keyframe.frame.camera.width, keyframe.frame.camera.height);
      observation.depth_m = static_cast<float>((observation.depth_m - sensor.depth_offset_m) / (1 - distortion));
    }
  }
  return keyframes;
}

TEST(BundleAdjustment, findsWhatTheSensorIsOffBy)
{
  SyntheticBundleOptions scene;
  scene.pixel_sigma_px = 0.3;
  scene.depth_sigma_scale = 1;
  scene.landmark_count = 2000;
  const std::vector<rgbd::Keyframe> truth = observedLandmarks(scene);
  rgbd::SensorCorrection sensor;
  sensor.focal_ratio = { 1.012, 0.991 };
  sensor.principal_shift_px = { 2.5, -3 };
  sensor.depth_offset_m = 0.004;
  BundleAdjustmentOptions options = withoutLinks();
  options.calibrate_intrinsics = options.calibrate_depth_offset = true;
  const std::vector<rgbd::Keyframe> given = mismeasured(truth, sensor);
  const BundleAdjustmentResult result = adjust(given, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const rgbd::SensorCorrection& found = result.sensor;
  for (int axis = 0; axis < 2; ++axis)
  {
    EXPECT_LT(found.focal_ratio_sigma[axis], 0.01);
    EXPECT_NEAR(found.focal_ratio[axis], sensor.focal_ratio[axis], 4 * found.focal_ratio_sigma[axis] + 2e-4);
    EXPECT_NEAR(found.principal_shift_px[axis], sensor.principal_shift_px[axis],
                4 * found.principal_shift_sigma_px[axis] + 0.1);
  }
  EXPECT_LT(found.principal_shift_sigma_px.x(), 3);
  EXPECT_GT(found.principal_shift_sigma_px.y(), 5);  // all cameras are held level: tilting them does the same
  EXPECT_LT(found.depth_offset_sigma_m, 0.002);
  EXPECT_NEAR(found.depth_offset_m, sensor.depth_offset_m, 4 * found.depth_offset_sigma_m + 1e-4);
  EXPECT_EQ(found.depth_ratio, 1);
  EXPECT_EQ(found.depth_ratio_sigma, 0);
  const test_support::PoseError with = test_support::largestError(result.T_session_camera, truth);
  const test_support::PoseError without = test_support::largestError(adjust(given).T_session_camera, truth);
  EXPECT_LT(with.translation_m, 0.5 * without.translation_m);
}

/// Knots that the landmarks of the synthetic bundle lie between, without their mean: that is the ratio of depth.
Eigen::VectorXd middleOf(const rgbd::DistortionGrid::Ratios& ratios)
{
  std::vector<double> middle;
  for (int row = 2; row <= 4; ++row)
    for (int column = 3; column <= 5; ++column)
      middle.push_back(ratios[row * rgbd::DistortionGrid::COLUMNS + column]);
  const Eigen::Map<const Eigen::VectorXd> values(middle.data(), static_cast<Eigen::Index>(middle.size()));
  return values.array() - values.mean();
}

TEST(BundleAdjustment, findsByWhatDepthIsDistorted)
{
  SyntheticBundleOptions scene;
  scene.pixel_sigma_px = 0.3;
  scene.depth_sigma_scale = 1;
  scene.camera_count = 24;
  scene.landmark_count = 2000;
  const std::vector<rgbd::Keyframe> truth = observedLandmarks(scene);
  BundleAdjustmentOptions options = withoutLinks();
  options.calibrate_depth_distortion = true;
  rgbd::SensorCorrection sensor;
  for (int i = 0; i < rgbd::DistortionGrid::KNOTS; ++i)
    sensor.depth_distortion_ratio[i] = 0.002 * std::sin(1.7 * i);
  const BundleAdjustmentResult result = adjust(mismeasured(truth, sensor), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Eigen::VectorXd expected = middleOf(sensor.depth_distortion_ratio);
  const Eigen::VectorXd error = middleOf(result.sensor.depth_distortion_ratio) - expected;
  EXPECT_LT(error.norm(), 0.4 * expected.norm());
  EXPECT_GT(result.sensor.depth_distortion_sigma_ratio.front(), 0.001);  // a corner that nothing is seen in
  EXPECT_LT(result.sensor.depth_distortion_sigma_ratio[3 * rgbd::DistortionGrid::COLUMNS + 4], 0.0005);
  double mean = 0;
  for (const double ratio : result.sensor.depth_distortion_ratio)
    mean += ratio / rgbd::DistortionGrid::KNOTS;
  EXPECT_NEAR(mean, 0, 1e-5);
  const BundleAdjustmentResult undistorted = adjust(truth, options);
  EXPECT_LT(middleOf(undistorted.sensor.depth_distortion_ratio).norm(), 0.3 * expected.norm());
}

TEST(BundleAdjustment, saysThatNothingTellsTheRatioOfDepth)
{
  SyntheticBundleOptions scene;
  scene.pixel_sigma_px = 0.3;
  BundleAdjustmentOptions options = withoutLinks();
  options.calibrate_depth_ratio = true;
  const BundleAdjustmentResult result = adjust(observedLandmarks(scene), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_NEAR(result.sensor.depth_ratio, 1, 0.01);
  EXPECT_GT(result.sensor.depth_ratio_sigma, 0.015);
}

TEST(BundleAdjustment, withstandsNoiseAndOutliers)
{
  SyntheticBundleOptions options;
  options.pixel_sigma_px = 0.5;
  options.depth_sigma_scale = 1;
  options.outlier_ratio = 0.1;
  options.landmark_count = 3000;
  options.step_rad = 0.09;
  const std::vector<rgbd::Keyframe> truth = observedLandmarks(options);
  const BundleAdjustmentResult result = adjust(test_support::perturbed(truth, 0.01, 0.02));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const test_support::PoseError error = test_support::largestError(result.T_session_camera, truth);
  EXPECT_LT(error.translation_m, 0.006);
  EXPECT_LT(error.rotation_rad, 0.01);
  for (const KeyframeResidual& residual : result.residuals)
  {
    EXPECT_LT(residual.reprojection_rmse_after_px, residual.reprojection_rmse_before_px);
    EXPECT_NEAR(residual.reprojection_rmse_after_px, 0.65, 0.25);
    EXPECT_NEAR(residual.depth_rmse_after_m, rgbd::SensorNoiseModel().axialSigma_m(0.58, 0), 0.0006);
    EXPECT_GT(residual.observation_count, 50);
  }
}

TEST(BundleAdjustment, covarianceForetellsTheError)
{
  SyntheticBundleOptions options;
  options.pixel_sigma_px = 0.5;
  options.depth_sigma_scale = 1;
  options.camera_count = 6;
  options.step_rad = 0.16;
  double squared = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    options.seed = seed;
    const std::vector<rgbd::Keyframe> truth = observedLandmarks(options);
    const BundleAdjustmentResult result = adjust(test_support::perturbed(truth, 0.003, 0.005));
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    for (std::size_t k = 1; k < truth.size(); ++k)
    {
      const geometry::Vector6d error =
          geometry::vectorFromIsometry(result.T_session_camera[k] * truth[k].T_session_camera.inverse());
      squared += error.dot(result.covariance[k].inverse() * error);
      count += 6;
    }
  }
  EXPECT_GT(squared / count, 0.5);
  EXPECT_LT(squared / count, 2.0);
}

TEST(BundleAdjustment, worksWithFewOrNoDepths)
{
  SyntheticBundleOptions options;
  options.missing_depth_ratio = 0.7;
  const std::vector<rgbd::Keyframe> truth = observedLandmarks(options);
  const BundleAdjustmentResult some = adjust(test_support::perturbed(truth, 0.005, 0.01));
  ASSERT_TRUE(some.status.ok()) << some.status.message;
  EXPECT_LT(test_support::largestError(some.T_session_camera, truth).translation_m, 5e-5);

  // Without depth the scale is free: right up to one factor.
  options.missing_depth_ratio = 1.1;
  const std::vector<rgbd::Keyframe> blind = observedLandmarks(options);
  const BundleAdjustmentResult none = adjust(test_support::perturbed(blind, 0.002, 0.003));
  ASSERT_TRUE(none.status.ok()) << none.status.message;
  const Eigen::Vector3d t_last = none.T_session_camera.back().translation();
  const Eigen::Vector3d t_last_truth = blind.back().T_session_camera.translation();
  EXPECT_GT(t_last.normalized().dot(t_last_truth.normalized()), 0.9999);
  EXPECT_LT(
      test_support::largestError({ none.T_session_camera[0] }, std::vector<rgbd::Keyframe>{ blind[0] }).translation_m,
      1e-12);
}

TEST(BundleAdjustment, leavesOutDisconnectedKeyframes)
{
  std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(observedLandmarks(), 0.003, 0.005);
  for (rgbd::Observation& observation : keyframes[4].observations)
    observation.landmark_id += 100000;
  keyframes[9].observations.clear();
  const BundleAdjustmentResult result = adjust(keyframes);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.left_out, (std::vector<int>{ 4, 9 }));
  EXPECT_EQ(result.T_session_camera[4].matrix(), keyframes[4].T_session_camera.matrix());
  EXPECT_EQ(result.T_session_camera[9].matrix(), keyframes[9].T_session_camera.matrix());
}

TEST(BundleAdjustment, answersNothingToAdjust)
{
  EXPECT_EQ(adjust({}).status.code, base::StatusCode::NO_RESULT);
  std::vector<rgbd::Keyframe> keyframes = observedLandmarks();
  const BundleAdjustmentResult one = adjust({ keyframes[0] });
  EXPECT_EQ(one.status.code, base::StatusCode::NO_RESULT);
  ASSERT_EQ(one.T_session_camera.size(), 1u);
  for (rgbd::Keyframe& keyframe : keyframes)
    keyframe.observations.clear();
  const BundleAdjustmentResult none = adjust(keyframes);
  EXPECT_EQ(none.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(none.left_out.size(), keyframes.size());
  EXPECT_FALSE(none.status.message.empty());
}

TEST(BundleAdjustment, returnsTheOldPosesWithoutConvergence)
{
  const std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(observedLandmarks(), 0.02, 0.04);
  BundleAdjustmentOptions options = withoutLinks();
  options.max_iterations = 1;
  const BundleAdjustmentResult result = adjust(keyframes, options);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(result.T_session_camera[5].matrix(), keyframes[5].T_session_camera.matrix());
}

TEST(BundleAdjustment, usesTheObjectAloneWhereAsked)
{
  // Half of the landmarks belong to a background that stands still while the object turns: it contradicts the object.
  const std::vector<rgbd::Keyframe> truth = observedLandmarks();
  std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(truth, 0.003, 0.005);
  for (rgbd::Keyframe& keyframe : keyframes)
  {
    keyframe.frame.object_mask = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
    keyframe.frame.object_mask.rowRange(400, 480) = 0;
    for (int i = 0; i < 300; ++i)
    {
      rgbd::Observation observation;
      observation.landmark_id = 5000 + i;
      observation.pixel = { static_cast<float>(20 + 2 * i), static_cast<float>(405 + i % 70) };
      observation.depth_m = 1.0f;
      keyframe.observations.push_back(observation);
    }
  }
  BundleAdjustmentOptions options = withoutLinks();
  options.object_only = true;
  const BundleAdjustmentResult result = adjust(keyframes, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_LT(test_support::largestError(result.T_session_camera, truth).translation_m, 5e-5);

  for (rgbd::Keyframe& keyframe : keyframes)
    keyframe.frame.object_mask.release();
  EXPECT_EQ(adjust(keyframes, options).status.code, base::StatusCode::NO_RESULT);
}

TEST(BundleAdjustment, ignoresMalformedObservations)
{
  const std::vector<rgbd::Keyframe> truth = observedLandmarks();
  std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(truth, 0.003, 0.005);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (rgbd::Keyframe& keyframe : keyframes)
  {
    rgbd::Observation twice = keyframe.observations[0];
    twice.pixel.x() += 30;
    keyframe.observations.push_back(twice);
    keyframe.observations.push_back({ 90001, { nan, 3 }, 1.0f });
    keyframe.observations.push_back({ 90002, { -50, 3 }, 1.0f });
    keyframe.observations.push_back({ 90003, { 5, 3 }, -1.0f });
    keyframe.observations.push_back({ 90004, { 5, 3 }, 0.0f });
  }
  const BundleAdjustmentResult result = adjust(keyframes);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_LT(test_support::largestError(result.T_session_camera, truth).translation_m, 5e-5);
}

TEST(BundleAdjustment, refusesBadInput)
{
  BundleAdjustmentOptions options = withoutLinks();
  options.pixel_sigma_px = 0;
  options.threads = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()), (std::vector<std::string>{ "pixel_sigma_px", "threads" }));
  EXPECT_THROW(adjust({}, options), base::Error);
  std::vector<rgbd::Keyframe> keyframes = observedLandmarks();
  keyframes[3].T_session_camera.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(adjust(keyframes), base::Error);
}

TEST(BundleAdjustment, givesTheSameBytesTwice)
{
  SyntheticBundleOptions scene;
  scene.pixel_sigma_px = 0.5;
  scene.outlier_ratio = 0.1;
  const std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(observedLandmarks(scene), 0.01, 0.02);
  const BundleAdjustmentResult first = adjust(keyframes), second = adjust(keyframes);
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    EXPECT_EQ(0, std::memcmp(first.T_session_camera[k].data(), second.T_session_camera[k].data(), 16 * sizeof(double)));
    EXPECT_EQ(0, std::memcmp(first.covariance[k].data(), second.covariance[k].data(), 36 * sizeof(double)));
  }
}

TEST(BundleAdjustment, stopsWhenCancelled)
{
  const std::vector<rgbd::Keyframe> keyframes = test_support::perturbed(observedLandmarks(), 0.01, 0.02);
  base::JobControl early;
  early.cancel();
  EXPECT_THROW(adjustBundle(keyframes, withoutLinks(), early), base::Cancelled);

  int reports = 0;
  base::JobControl* handle = nullptr;
  base::JobControl control(
      [&](const base::Progress& progress)
      {
        EXPECT_EQ(progress.stage, "bundle adjustment");
        if (++reports == 2)
          handle->cancel();
      });
  handle = &control;
  EXPECT_THROW(adjustBundle(keyframes, withoutLinks(), control), base::Cancelled);
  EXPECT_EQ(reports, 2);
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
