#include "support/synthetic_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include <opencv2/imgproc.hpp>

#include "support/handheld_trajectory.h"
#include "support/transform_matchers.h"

namespace object_modelling::test_support
{
namespace
{
SyntheticScene allShapes()
{
  SyntheticScene scene = boxOnTable();
  scene.objects.push_back(standingCylinder(0.08, 0.15, 0.2, 0.1));
  scene.objects.push_back(standingSphere(0.1, -0.1, 0.2));
  scene.objects.push_back(standingBox({ 0.1, 0.07, 0.05 }, 0.1, -0.2, 0.5, 9));
  return scene;
}

TEST(SyntheticScene, EveryPixelLiesOnTheSurfaceThatItNames)
{
  const SyntheticScene scene = allShapes();
  const Eigen::Isometry3d T_world_camera = orbitPose({ 0, 0, 0.08 }, 0.7, 0.8, 0.6);
  const SceneImage image = renderScene(scene, vgaCamera(), T_world_camera);
  std::vector<int> counts(scene.objects.size() + 1);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
    {
      if (!(image.depth_m.at<float>(v, u) > 0))
        continue;
      const Eigen::Vector3d p_world = T_world_camera * image.frame.point(u, v).cast<double>();
      const int instance = image.instances.at<std::uint8_t>(v, u);
      ++counts[static_cast<std::size_t>(instance)];
      const double distance =
          instance == 0 ? p_world.z() : scene.objects[static_cast<std::size_t>(instance - 1)].signedDistance_m(p_world);
      ASSERT_NEAR(distance, 0, 2e-6) << u << ", " << v << ", instance " << instance;
    }
  for (std::size_t i = 0; i < counts.size(); ++i)
    EXPECT_GT(counts[i], 1000) << i;
}

TEST(SyntheticScene, NormalsAreTheSlopeOfTheSurface)
{
  const SyntheticScene scene = allShapes();
  const Eigen::Isometry3d T_world_camera = orbitPose({ 0, 0, 0.08 }, 0.7, 0.8, 0.6);
  const SceneImage image = renderScene(scene, vgaCamera(), T_world_camera);
  constexpr double STEP_M = 1e-3;
  for (int v = 0; v < 480; v += 7)
    for (int u = 0; u < 640; u += 7)
    {
      const int instance = image.instances.at<std::uint8_t>(v, u);
      if (instance == 0)
        continue;
      const cv::Vec3f& n = image.normals.at<cv::Vec3f>(v, u);
      const Eigen::Vector3d n_world = T_world_camera.linear() * Eigen::Vector3d(n[0], n[1], n[2]);
      const Eigen::Vector3d p_world = T_world_camera * image.frame.point(u, v).cast<double>();
      const SceneObject& object = scene.objects[static_cast<std::size_t>(instance - 1)];
      EXPECT_NEAR(n_world.norm(), 1, 1e-5);
      EXPECT_NEAR(object.signedDistance_m(p_world + STEP_M * n_world), STEP_M, 1e-5);
    }
}

TEST(SyntheticScene, SignedDistanceKnownAnswers)
{
  const SceneObject box = standingBox({ 0.2, 0.4, 0.6 });
  EXPECT_NEAR(box.signedDistance_m({ 0, 0, 0.3 }), -0.1, 1e-12);
  EXPECT_NEAR(box.signedDistance_m({ 0.3, 0, 0.3 }), 0.2, 1e-12);
  EXPECT_NEAR(box.signedDistance_m({ 0.4, 0.6, 0.3 }), 0.5, 1e-12);
  const SceneObject cylinder = standingCylinder(0.2, 0.6);
  EXPECT_NEAR(cylinder.signedDistance_m({ 0, 0.3, 0.3 }), 0.2, 1e-12);
  EXPECT_NEAR(cylinder.signedDistance_m({ 0, 0, 0.7 }), 0.1, 1e-12);
  EXPECT_NEAR(standingSphere(0.2).signedDistance_m({ 0, 0, 0.25 }), 0.05, 1e-12);
}

TEST(SyntheticScene, MaskIsTheFirstObject)
{
  const SceneImage image = renderScene(allShapes(), vgaCamera(), orbitPose({ 0, 0, 0.08 }, 0.7, 0.8, 0.6));
  const cv::Mat first = image.instances == 1;
  EXPECT_EQ(cv::norm(image.frame.object_mask, first, cv::NORM_INF), 0);
  EXPECT_GT(cv::countNonZero(first), 1000);
}

TEST(SyntheticScene, TwoViewsSeeTheSameColors)
{
  const SyntheticScene scene = boxOnTable();
  const geometry::PinholeCamera camera = vgaCamera();
  const Eigen::Isometry3d T_world_a = orbitPose({ 0, 0, 0.08 }, 0.7, 0.5, 0.6);
  const Eigen::Isometry3d T_world_b = orbitPose({ 0, 0, 0.08 }, 0.72, 0.58, 0.63);
  const rgbd::Frame a = renderFrame(scene, camera, T_world_a);
  const rgbd::Frame b = renderFrame(scene, camera, T_world_b);
  const Eigen::Isometry3d T_b_a = T_world_b.inverse() * T_world_a;
  double sum = 0;
  int count = 0;
  for (int v = 100; v < 400; v += 2)
    for (int u = 150; u < 500; u += 2)
    {
      const Eigen::Vector3d p_b = T_b_a * a.point(u, v).cast<double>();
      const Eigen::Vector2d pixel = camera.project(p_b);
      if (!(p_b.z() > 0) || !camera.contains(pixel, 2))
        continue;
      cv::Mat value;
      cv::getRectSubPix(b.gray, cv::Size(1, 1), cv::Point2f(pixel.cast<float>().x(), pixel.cast<float>().y()), value);
      sum += std::abs(value.at<std::uint8_t>(0) - a.gray.at<std::uint8_t>(v, u));
      ++count;
    }
  EXPECT_GT(count, 10000);
  EXPECT_LT(sum / count, 3.0);  // gray levels; the texture's own contrast is more than ten times that
  cv::Scalar mean, deviation;
  cv::meanStdDev(a.gray, mean, deviation, a.object_mask);
  EXPECT_GT(deviation[0], 20);
}

TEST(SyntheticScene, TexturedIsRichInCornersPlainHasNone)
{
  SyntheticScene scene;
  scene.table_half_size_m = 10;
  const auto corners = [&]
  {
    std::vector<cv::Point2f> found;
    cv::goodFeaturesToTrack(renderFrame(scene, vgaCamera(), orbitPose({ 0, 0, 0 }, 0.7, 0, 0.8)).gray, found, 500, 0.05,
                            8);
    return found.size();
  };
  EXPECT_EQ(corners(), 500u);
  scene.table = plainTexture();
  EXPECT_EQ(corners(), 0u);
}

TEST(SyntheticScene, NothingBeyondTheTableAndNothingFromBelow)
{
  SyntheticScene scene;
  const rgbd::Frame above = renderFrame(scene, vgaCamera(), orbitPose({ 0, 0, 0 }, 2.0, 0, 0.5));
  EXPECT_TRUE(std::isnan(above.depthAt_m(320, 5)));
  EXPECT_FALSE(std::isnan(above.depthAt_m(320, 240)));
  const rgbd::Frame below = renderFrame(scene, vgaCamera(), orbitPose({ 0, 0, 0 }, 2.0, 0, -0.5));
  EXPECT_EQ(cv::countNonZero(below.depth_m == below.depth_m), 0);
}

TEST(SyntheticScene, NoiseIsAsAskedForAndTheTruthStays)
{
  SyntheticScene scene;
  scene.table_half_size_m = 10;
  SensorNoise noise;
  noise.depth_sigma_scale = 1;
  noise.missing_ratio = 0.1;
  noise.color_sigma = 5;
  const Eigen::Isometry3d T_world_camera = orbitPose({ 0, 0, 0 }, 1.0, 0, M_PI / 2 - 0.01);
  const SceneImage image = renderScene(scene, vgaCamera(), T_world_camera, noise);
  const SceneImage clean = renderScene(scene, vgaCamera(), T_world_camera);
  EXPECT_EQ(cv::norm(image.depth_m, clean.depth_m, cv::NORM_INF), 0);
  const cv::Mat measured = image.frame.depth_m == image.frame.depth_m;
  EXPECT_NEAR(cv::countNonZero(measured) / (640.0 * 480.0), 0.9, 0.01);
  cv::Scalar mean, deviation;
  cv::meanStdDev(image.frame.depth_m - image.depth_m, mean, deviation, measured);
  EXPECT_NEAR(mean[0], 0, 5e-5);
  EXPECT_NEAR(deviation[0], 0.001884, 5e-5);  // Nguyen's axial sigma at 1 m
  cv::Mat difference;
  cv::subtract(image.frame.color_bgr, clean.frame.color_bgr, difference, cv::noArray(), CV_16SC3);
  cv::meanStdDev(difference, mean, deviation);
  EXPECT_NEAR(deviation[1], 5, 0.3);
}

TEST(SyntheticScene, QuantisedDepthIsOnItsGrid)
{
  SensorNoise noise;
  noise.depth_quantum_m = 0.002;
  const rgbd::Frame frame = renderFrame(boxOnTable(), vgaCamera(), orbitPose({ 0, 0, 0.08 }, 0.7, 0.5, 0.6), noise);
  for (int u = 0; u < 640; u += 5)
  {
    const double steps = frame.depthAt_m(u, 240) / 0.002;
    if (std::isnan(steps))
      continue;
    EXPECT_NEAR(steps, std::round(steps), 1e-3);
  }
}

TEST(SyntheticScene, EdgesLoseTheirDepth)
{
  SensorNoise noise;
  noise.missing_edge_px = 2;
  const Eigen::Isometry3d T_world_camera = orbitPose({ 0, 0, 0.08 }, 0.7, 0.5, 0.6);
  const SceneImage image = renderScene(boxOnTable(), vgaCamera(), T_world_camera, noise);
  const cv::Mat lost = (image.depth_m == image.depth_m) & ~(image.frame.depth_m == image.frame.depth_m);
  EXPECT_GT(cv::countNonZero(lost), 500);
  EXPECT_LT(cv::countNonZero(lost), 20000);
}

TEST(SyntheticScene, SeedDecides)
{
  SensorNoise noise;
  noise.depth_sigma_scale = 1;
  const Eigen::Isometry3d T_world_camera = orbitPose({ 0, 0, 0.08 }, 0.7, 0.5, 0.6);
  const auto depth = [&]
  {
    cv::Mat depth_m = renderFrame(boxOnTable(), vgaCamera(), T_world_camera, noise).depth_m.clone();
    cv::patchNaNs(depth_m, 0);
    return depth_m;
  };
  const cv::Mat first = depth();
  EXPECT_EQ(cv::norm(first, depth(), cv::NORM_INF), 0);
  noise.seed = 2;
  EXPECT_GT(cv::norm(first, depth(), cv::NORM_INF), 0);
}

TEST(SyntheticScene, KeyframesCarryPosesAndMasks)
{
  const std::vector<Eigen::Isometry3d> poses = orbitPoses(3);
  const std::vector<rgbd::Keyframe> keyframes = renderKeyframes(boxOnTable(), vgaCamera().scaled(0.25), poses);
  ASSERT_EQ(keyframes.size(), 3u);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(keyframes[i].id, i);
    EXPECT_EQ(keyframes[i].frame.depth_m.cols, 160);
    EXPECT_GT(cv::countNonZero(keyframes[i].frame.object_mask), 100);
    EXPECT_TRANSFORM_NEAR(keyframes[i].T_session_camera, poses[i], 0, 1e-7);
  }
}

TEST(HandheldTrajectory, KeepsItsTargetInViewAndMovesSmoothly)
{
  HandheldOptions options;
  options.frame_count = 300;
  const std::vector<StampedCamera> trajectory = handheldTrajectory(options);
  ASSERT_EQ(trajectory.size(), 300u);
  EXPECT_DOUBLE_EQ(trajectory.front().stamp_s, 1000);
  EXPECT_NEAR(trajectory.back().stamp_s, 1000 + 299 / 30.0, 1e-9);
  const geometry::PinholeCamera camera = vgaCamera();
  for (std::size_t i = 0; i < trajectory.size(); ++i)
  {
    const Eigen::Vector3d target = trajectory[i].T_world_camera.inverse() * options.target;
    EXPECT_NEAR(target.norm(), options.radius_m, 0.01);
    EXPECT_LT((camera.project(target) - Eigen::Vector2d(319.5, 239.5)).norm(), 20);
    const std::size_t before = i > 0 ? i - 1 : 0;
    EXPECT_TRANSFORM_NEAR(trajectory[i].T_world_camera, trajectory[before].T_world_camera, 0.03, 0.04);
  }
  EXPECT_TRANSFORM_NEAR(trajectory.back().T_world_camera, trajectory.front().T_world_camera, 0.02, 0.03);
}

TEST(LookAt, ImageIsUpright)
{
  const Eigen::Isometry3d T_world_camera = lookAt({ 1, 0, 1 }, { 0, 0, 0 });
  EXPECT_NEAR(T_world_camera.linear().determinant(), 1, 1e-12);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  EXPECT_TRUE((T_camera_world * Eigen::Vector3d::Zero()).isApprox(Eigen::Vector3d(0, 0, std::sqrt(2.0)), 1e-12));
  EXPECT_LT((T_camera_world * Eigen::Vector3d(0, 0, 0.1)).y(), 0);  // higher in the world is higher in the image
  EXPECT_GT((T_camera_world * Eigen::Vector3d(0, 0.1, 0)).x(), 0);
  EXPECT_NO_THROW(lookAt({ 0, 0, 1 }, { 0, 0, 0 }));
}

}  // namespace
}  // namespace object_modelling::test_support
