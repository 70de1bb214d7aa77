#include "object_modelling/bundle_adjustment/keyframe_linker.h"

#include <cstring>

#include <gtest/gtest.h>

#include "link_scene.h"
#include "object_modelling/bundle_adjustment/bundle_adjustment.h"
#include "support/handheld_trajectory.h"
#include "support/pose_errors.h"
#include "support/synthetic_scene.h"
#include "support/violations.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
using test_support::boxOnTable;
using test_support::orbitPose;
using test_support::renderKeyframes;

const Eigen::Vector3d TARGET(0, 0, 0.08);

std::vector<Eigen::Isometry3d> orbit(int count, double begin_rad, double end_rad, double radius_m = 0.6)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(orbitPose(TARGET, radius_m, begin_rad + (end_rad - begin_rad) * i / (count - 1), 0.6));
  return poses;
}

/// Once round a textured box; the last view is that of the first and a bit.
const std::vector<rgbd::Keyframe>& loopScene()
{
  static const std::vector<rgbd::Keyframe> keyframes = []
  {
    test_support::SensorNoise noise;
    noise.depth_sigma_scale = 0.5;
    noise.color_sigma = 2;
    test_support::SyntheticScene scene = boxOnTable();
    scene.objects[0].texture.cell_m = 0.012f;
    std::vector<rgbd::Keyframe> rendered =
        renderKeyframes(scene, test_support::vgaCamera(), orbit(25, 0, 2 * M_PI + 0.05), noise);
    return rendered;
  }();
  return keyframes;
}

std::vector<VerifiedLink> linksOf(const std::vector<rgbd::Keyframe>& keyframes, KeyframeLinkerOptions options = {})
{
  base::JobControl control;
  const Eigen::MatrixXi none =
      Eigen::MatrixXi::Zero(static_cast<Eigen::Index>(keyframes.size()), static_cast<Eigen::Index>(keyframes.size()));
  return linkKeyframes(keyframes, none, 30, options, control);
}

TEST(KeyframeLinker, measuresTheRelativePose)
{
  const std::vector<rgbd::Keyframe> pair(loopScene().begin(), loopScene().begin() + 2);
  const std::vector<VerifiedLink> links = linksOf(pair);
  ASSERT_EQ(links.size(), 1u);
  const Eigen::Isometry3d T_a_b = pair[0].T_session_camera.inverse() * pair[1].T_session_camera;
  EXPECT_LT((links[0].T_a_b.inverse() * T_a_b).translation().norm(), 0.003);
  EXPECT_LT(geometry::rotationAngle_rad(links[0].T_a_b.inverse() * T_a_b), 0.005);
  for (const LinkedPoint& point : links[0].points)
  {
    EXPECT_GT(point.depth_a_m, 0);
    EXPECT_GT(point.sigma_b_px, 0);
  }
}

TEST(KeyframeLinker, skipsPairsThatTheTrackerLinked)
{
  const std::vector<rgbd::Keyframe> pair(loopScene().begin(), loopScene().begin() + 2);
  base::JobControl control;
  EXPECT_TRUE(linkKeyframes(pair, Eigen::MatrixXi::Constant(2, 2, 100), 30, {}, control).empty());
}

TEST(KeyframeLinker, takesKeyframesWithoutImagesOrDepth)
{
  std::vector<rgbd::Keyframe> keyframes(loopScene().begin(), loopScene().begin() + 3);
  keyframes[0].frame.gray.release();
  keyframes[0].frame.depth_m.release();
  keyframes[1].frame.depth_m = cv::Mat(480, 640, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  keyframes[2].frame.gray = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
  EXPECT_TRUE(linksOf(keyframes).empty());
  EXPECT_TRUE(linksOf({}).empty());
}

TEST(KeyframeLinker, staysOnTheObjectWhereAsked)
{
  std::vector<rgbd::Keyframe> pair(loopScene().begin(), loopScene().begin() + 2);
  KeyframeLinkerOptions options;
  options.object_only = true;
  const std::vector<VerifiedLink> links = linksOf(pair, options);
  ASSERT_EQ(links.size(), 1u);
  for (const LinkedPoint& point : links[0].points)
  {
    EXPECT_NE(pair[0].frame.object_mask.at<std::uint8_t>(point.pixel_a.y(), point.pixel_a.x()), 0);
    EXPECT_NE(pair[1].frame.object_mask.at<std::uint8_t>(point.pixel_b.y(), point.pixel_b.x()), 0);
  }
  pair[1].frame.object_mask.release();
  EXPECT_TRUE(linksOf(pair, options).empty());
}

TEST(KeyframeLinker, refusesBadOptions)
{
  KeyframeLinkerOptions options;
  options.min_inliers = 1;
  options.max_match_ratio = 2;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "max_match_ratio", "min_inliers" }));
  EXPECT_THROW(linksOf({}, options), base::Error);
}

TEST(KeyframeLinker, closesALoopWithDrift)
{
  for (bool object_only : { false, true })
  {
    std::vector<rgbd::Keyframe> truth = loopScene();
    observeNeighbors(&truth, 0.5, object_only ? 12 : 40, object_only);
    geometry::Vector6d per_step;
    per_step << 0.0035, 0, 0, 0, 0.0065, 0;  // 84 mm and 9 deg over 24 steps
    const std::vector<rgbd::Keyframe> keyframes = drifted(truth, per_step);
    BundleAdjustmentOptions options;
    options.object_only = object_only;
    base::JobControl control;
    const BundleAdjustmentResult result = adjustBundle(keyframes, options, control);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(result.left_out.empty());
    bool closed = false;
    for (const KeyframeLink& link : result.links)
    {
      if (link.keyframe_b - link.keyframe_a < 23)
        continue;
      closed = true;
      EXPECT_GT(link.translation_error_before_m, 0.05);
      EXPECT_LT(link.translation_error_after_m, 0.005);
      EXPECT_LT(link.rotation_error_after_rad, 0.009);
    }
    EXPECT_TRUE(closed);
    const test_support::PoseError error = test_support::largestError(result.T_session_camera, truth);
    EXPECT_LT(error.translation_m, object_only ? 0.008 : 0.004);
    EXPECT_LT(error.rotation_rad, object_only ? 0.012 : 0.007);
  }
}

/// Along a table with two boxes that look the same, from one to the other.
std::vector<rgbd::Keyframe> twinScene()
{
  test_support::SyntheticScene scene;
  scene.table.cell_m = 0.03f;
  for (double x : { -0.3, 0.3 })
  {
    test_support::SceneObject box = test_support::standingBox({ 0.2, 0.2, 0.2 }, x, 0, 0.5);
    box.texture.cell_m = 0.015f;
    scene.objects.push_back(box);
  }
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i <= 8; ++i)
  {
    const double x = -0.3 + 0.6 * i / 8;
    poses.push_back(test_support::lookAt({ x, -0.35, 0.45 }, { x, 0, 0.1 }));
  }
  return renderKeyframes(scene, test_support::vgaCamera(), poses);
}

TEST(KeyframeLinker, dropsALinkBetweenThingsThatLookTheSame)
{
  std::vector<rgbd::Keyframe> keyframes = twinScene();
  // The match in itself is perfect: nothing but the other keyframes can tell.
  const std::vector<VerifiedLink> alone = linksOf({ keyframes.front(), keyframes.back() });
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_LT(alone[0].T_a_b.translation().norm(), 0.01);

  observeNeighbors(&keyframes, 0.3, 40, false);
  base::JobControl control;
  const BundleAdjustmentResult result = adjustBundle(keyframes, {}, control);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_FALSE(result.rejected_links.empty());
  for (const KeyframeLink& link : result.links)
    EXPECT_LT(link.translation_error_after_m, 0.01);
  EXPECT_LT(test_support::largestError(result.T_session_camera, keyframes).translation_m, 0.003);
}

TEST(KeyframeLinker, givesTheSameBytesOnAnyNumberOfThreads)
{
  const std::vector<rgbd::Keyframe> keyframes(loopScene().begin(), loopScene().begin() + 5);
  const std::vector<VerifiedLink> parallel = linksOf(keyframes);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const std::vector<VerifiedLink> serial = linksOf(keyframes);
  cv::setNumThreads(threads);
  ASSERT_EQ(parallel.size(), serial.size());
  ASSERT_GT(parallel.size(), 3u);
  for (std::size_t i = 0; i < parallel.size(); ++i)
  {
    ASSERT_EQ(parallel[i].points.size(), serial[i].points.size());
    EXPECT_EQ(0, std::memcmp(parallel[i].T_a_b.data(), serial[i].T_a_b.data(), 16 * sizeof(double)));
  }
}

TEST(KeyframeLinker, stopsWhenCancelled)
{
  base::JobControl* handle = nullptr;
  base::JobControl control(
      [&](const base::Progress& progress)
      {
        if (progress.stage == "keyframe links")
          handle->cancel();
      });
  handle = &control;
  const std::vector<rgbd::Keyframe> keyframes(loopScene().begin(), loopScene().begin() + 8);
  EXPECT_THROW(linkKeyframes(keyframes, Eigen::MatrixXi::Zero(8, 8), 30, {}, control), base::Cancelled);
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
