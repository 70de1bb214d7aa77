#include "object_modelling/segmentation/scene_segmenter.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scene_fixtures.h"
#include "support/violations.h"

namespace object_modelling::segmentation
{
namespace
{
using test_support::orbitPose;
using test_support::renderScene;
using test_support::SceneImage;
using test_support::standingBox;
using test_support::standingCylinder;
using test_support::SyntheticScene;
using test_support::vgaCamera;

constexpr double DEG = M_PI / 180;

SceneImage viewOf(const SyntheticScene& scene, double elevation_deg = 40, double radius_m = 0.8)
{
  return renderScene(scene, vgaCamera(), orbitPose({ 0, 0, 0.05 }, radius_m, 0.5, elevation_deg * DEG), kinectNoise());
}

}  // namespace

TEST(SceneSegmenter, FindsTheBoxFromLowToSteepViews)
{
  for (const double elevation_deg : { 12.0, 25.0, 45.0, 65.0, 80.0 })
  {
    const SceneImage image = viewOf(test_support::boxOnTable(), elevation_deg);
    const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
    ASSERT_TRUE(segmentation.status.ok()) << elevation_deg << " deg: " << segmentation.status.message;
    EXPECT_GT(bestOverlap(segmentation, image, 0), 0.93) << elevation_deg << " deg";
    const geometry::Plane table = geometry::transformed(orbitPose({ 0, 0, 0.05 }, 0.8, 0.5, elevation_deg * DEG),
                                                        segmentation.planes[segmentation.support_plane].plane_camera);
    EXPECT_GT(table.normal.z(), std::cos(0.3 * DEG)) << elevation_deg << " deg";
    EXPECT_NEAR(table.offset_m, 0, 0.001) << elevation_deg << " deg";
  }
}

TEST(SceneSegmenter, FindsFlatThinAndTallObjects)
{
  SyntheticScene scene;
  scene.objects = { standingBox({ 0.12, 0.08, 0.03 }, -0.18, 0), standingCylinder(0.03, 0.15, 0.0, 0.0),
                    standingBox({ 0.07, 0.2, 0.3 }, 0.2, -0.05), standingBox({ 0.2, 0.03, 0.03 }, 0, 0.2) };
  const SceneImage image = viewOf(scene, 45, 0.9);
  const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
  ASSERT_TRUE(segmentation.status.ok()) << segmentation.status.message;
  EXPECT_EQ(segmentation.hypotheses.size(), 4U);
  for (int object = 0; object < 4; ++object)
    EXPECT_GT(bestOverlap(segmentation, image, object), 0.88) << "object " << object;
}

TEST(SceneSegmenter, BoxStandsOnTheSupportWithTheObjectsSize)
{
  const SceneImage image = viewOf(test_support::boxOnTable(), 50);
  const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
  ASSERT_TRUE(segmentation.status.ok()) << segmentation.status.message;
  const geometry::OrientedBox& box = segmentation.hypotheses.front().box_camera;
  const geometry::Plane& support = segmentation.planes[segmentation.support_plane].plane_camera;
  EXPECT_NEAR(box.size_m.z(), 0.2, 0.005);
  EXPECT_NEAR(support.signedDistance_m(box.T_frame_box * Eigen::Vector3d(0, 0, -box.size_m.z() / 2)), 0, 1e-6);
  EXPECT_NEAR(box.T_frame_box.linear().col(2).dot(support.normal), 1, 1e-6);
  EXPECT_NEAR(box.size_m.x(), 0.12, 0.012);
  EXPECT_NEAR(box.size_m.y(), 0.08, 0.012);
}

TEST(SceneSegmenter, TurntableNotTheTableBelowIsTheSupport)
{
  SyntheticScene scene;
  scene.objects = { standingCylinder(0.4, 0.05), standingBox({ 0.08, 0.08, 0.12 }) };
  scene.objects[1].T_world_object.pretranslate(Eigen::Vector3d(0, 0, 0.05));
  const SceneImage image = viewOf(scene, 35, 0.7);
  const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
  ASSERT_TRUE(segmentation.status.ok()) << segmentation.status.message;
  EXPECT_GT(bestOverlap(segmentation, image, 1), 0.93);
}

TEST(SceneSegmenter, LeavesOutWhatStandsBeyondTheTable)
{
  SyntheticScene scene = test_support::boxOnTable();
  scene.table_half_size_m = 0.25;
  scene.objects.push_back(standingBox({ 0.4, 0.4, 0.3 }, -0.9, -0.5));
  const SceneImage image = viewOf(scene, 30);
  ASSERT_GT(cv::countNonZero(image.instances == 2), 300);
  const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
  ASSERT_TRUE(segmentation.status.ok()) << segmentation.status.message;
  EXPECT_GT(bestOverlap(segmentation, image, 0), 0.95);
  EXPECT_LT(bestOverlap(segmentation, image, 1), 0.1);
}

TEST(SceneSegmenter, AnyImageSize)
{
  for (const double factor : { 0.25, 0.5, 2.0 })
  {
    const SceneImage image =
        renderScene(test_support::boxOnTable(), vgaCamera().scaled(factor), orbitPose({ 0, 0, 0.05 }, 0.7, 0.5, 0.7));
    const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
    ASSERT_TRUE(segmentation.status.ok()) << factor << ": " << segmentation.status.message;
    EXPECT_GT(bestOverlap(segmentation, image, 0), 0.93) << factor;
  }
}

TEST(SceneSegmenter, SaysThatThereIsNoPlane)
{
  rgbd::Frame frame;
  frame.camera = smallCamera();
  frame.depth_m =
      cv::Mat(frame.camera.height, frame.camera.width, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  SceneSegmentation segmentation = SceneSegmenter().segment(frame);
  EXPECT_EQ(segmentation.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(segmentation.status.message.find("no pixel of the frame has depth"), std::string::npos);
  EXPECT_EQ(segmentation.support_plane, -1);

  cv::RNG random(7);
  random.fill(frame.depth_m, cv::RNG::UNIFORM, 0.5, 3.0);
  segmentation = SceneSegmenter().segment(frame);
  EXPECT_EQ(segmentation.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(segmentation.status.message.find("no plane"), std::string::npos);
}

TEST(SceneSegmenter, SaysThatNothingStandsOnTheTable)
{
  const SceneImage image = viewOf(SyntheticScene{});
  const SceneSegmentation segmentation = SceneSegmenter().segment(image.frame);
  EXPECT_EQ(segmentation.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(segmentation.status.message.find("no hypothesis"), std::string::npos);
  EXPECT_EQ(segmentation.support_plane, 0);
  EXPECT_TRUE(segmentation.hypotheses.empty());
}

TEST(SceneSegmenter, RefusesFramesWithoutDepthOrIntrinsics)
{
  rgbd::Frame frame;
  EXPECT_EQ(SceneSegmenter().segment(frame).status.code, base::StatusCode::BAD_INPUT);
  frame.depth_m = cv::Mat::ones(48, 64, CV_32FC1);
  EXPECT_EQ(SceneSegmenter().segment(frame).status.code, base::StatusCode::BAD_INPUT);
}

TEST(SceneSegmenter, IsDeterministic)
{
  const SceneImage image = viewOf(test_support::boxOnTable());
  const SceneSegmentation a = SceneSegmenter().segment(image.frame), b = SceneSegmenter().segment(image.frame);
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i)
  {
    EXPECT_EQ(cv::countNonZero(a.hypotheses[i].mask != b.hypotheses[i].mask), 0);
    EXPECT_EQ(a.hypotheses[i].box_camera.size_m, b.hypotheses[i].box_camera.size_m);
  }
  EXPECT_EQ(a.planes[0].plane_camera.normal, b.planes[0].plane_camera.normal);
}

TEST(SceneSegmenter, NamesEveryBrokenOption)
{
  SceneSegmenterOptions options;
  options.plane_angle_rad = -1;
  options.max_height_m = 0;
  options.min_cluster_px = 0;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "max_height_m", "min_cluster_px", "plane_angle_rad" }));
  EXPECT_THROW(SceneSegmenter{ options }, base::Error);
}

}  // namespace object_modelling::segmentation
