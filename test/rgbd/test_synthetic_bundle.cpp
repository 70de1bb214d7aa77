#include "support/synthetic_bundle.h"

#include <gtest/gtest.h>

#include <map>

#include "support/transform_matchers.h"

namespace object_modelling::test_support
{
namespace
{
/// Reprojection error (px) of an observation at the true pose.
double error_px(const SyntheticBundle& bundle, std::size_t camera, const rgbd::Observation& observation)
{
  const Eigen::Vector3d p_camera =
      bundle.T_session_cameras[camera].inverse() * bundle.landmarks[observation.landmark_id];
  return (bundle.keyframes[camera].frame.camera.project(p_camera) - observation.pixel.cast<double>()).norm();
}

TEST(SyntheticBundle, IsExactWithoutNoise)
{
  const SyntheticBundle bundle = makeSyntheticBundle();
  ASSERT_EQ(bundle.keyframes.size(), 12u);
  EXPECT_TRANSFORM_NEAR(bundle.T_session_cameras.front(), Eigen::Isometry3d::Identity(), 1e-12, 1e-7);
  for (std::size_t i = 0; i < bundle.keyframes.size(); ++i)
  {
    EXPECT_TRANSFORM_NEAR(bundle.keyframes[i].T_session_camera, bundle.T_session_cameras[i], 1e-12, 1e-7);
    EXPECT_GT(bundle.keyframes[i].observations.size(), 50u);
    for (const rgbd::Observation& observation : bundle.keyframes[i].observations)
    {
      EXPECT_LT(error_px(bundle, i, observation), 1e-3);
      const Eigen::Vector3d p = bundle.T_session_cameras[i].inverse() * bundle.landmarks[observation.landmark_id];
      EXPECT_NEAR(observation.depth_m, p.z(), 1e-6);
    }
  }
}

TEST(SyntheticBundle, LandmarksAreSharedByNeighborsAndOverTheClosure)
{
  const SyntheticBundle bundle = makeSyntheticBundle();
  std::map<std::uint64_t, int> seen;
  for (const rgbd::Observation& observation : bundle.keyframes.front().observations)
    ++seen[observation.landmark_id];
  int shared = 0;
  for (const rgbd::Observation& observation : bundle.keyframes.back().observations)
    shared += static_cast<int>(seen.count(observation.landmark_id));
  EXPECT_GT(shared, 20);
}

TEST(SyntheticBundle, NoiseAndOutliersAreAsAskedFor)
{
  SyntheticBundleOptions options;
  options.pixel_sigma_px = 0.5;
  options.outlier_ratio = 0.1;
  options.missing_depth_ratio = 0.2;
  options.pose_error_m = 0.01;
  options.pose_error_rad = 0.02;
  const SyntheticBundle bundle = makeSyntheticBundle(options);
  double sum_squares = 0;
  int inliers = 0, outliers = 0, missing = 0;
  for (std::size_t i = 0; i < bundle.keyframes.size(); ++i)
    for (std::size_t j = 0; j < bundle.keyframes[i].observations.size(); ++j)
    {
      const rgbd::Observation& observation = bundle.keyframes[i].observations[j];
      missing += observation.depth_m != observation.depth_m ? 1 : 0;
      const double error = error_px(bundle, i, observation);
      if (bundle.observation_outliers[i][j])
      {
        ++outliers;
        EXPECT_GE(error, 19.9);
        continue;
      }
      ++inliers;
      sum_squares += error * error;
    }
  EXPECT_NEAR(std::sqrt(sum_squares / (2 * inliers)), 0.5, 0.05);
  EXPECT_NEAR(static_cast<double>(outliers) / (inliers + outliers), 0.1, 0.03);
  EXPECT_NEAR(static_cast<double>(missing) / (inliers + outliers), 0.2, 0.04);
  EXPECT_TRANSFORM_NEAR(bundle.keyframes[0].T_session_camera, bundle.T_session_cameras[0], 1e-12, 1e-7);
  EXPECT_GT((bundle.keyframes[5].T_session_camera.translation() - bundle.T_session_cameras[5].translation()).norm(),
            1e-3);
}

TEST(SyntheticBundle, SeedDecides)
{
  SyntheticBundleOptions options;
  options.pixel_sigma_px = 1;
  const SyntheticBundle a = makeSyntheticBundle(options);
  const SyntheticBundle b = makeSyntheticBundle(options);
  options.seed = 2;
  const SyntheticBundle c = makeSyntheticBundle(options);
  EXPECT_EQ(a.keyframes[3].observations[7].pixel, b.keyframes[3].observations[7].pixel);
  EXPECT_NE(a.keyframes[3].observations[7].pixel, c.keyframes[3].observations[7].pixel);
}

}  // namespace
}  // namespace object_modelling::test_support
