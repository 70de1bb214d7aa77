#include "object_volume.h"

#include <gtest/gtest.h>

namespace object_modelling::segmentation
{
namespace
{
/// A wall of the given depth, seen by a camera that stands `x_m` to the side.
rgbd::Keyframe wall(float depth_m, double x_m = 0)
{
  rgbd::Keyframe keyframe;
  geometry::PinholeCamera& camera = keyframe.frame.camera;
  camera.width = camera.height = 100;
  camera.fx = camera.fy = 200;
  camera.cx = camera.cy = 49.5;
  keyframe.frame.depth_m = cv::Mat(100, 100, CV_32FC1, cv::Scalar(depth_m));
  keyframe.T_session_camera.translation().x() = x_m;
  return keyframe;
}

cv::Mat patch()
{
  cv::Mat mask = cv::Mat::zeros(100, 100, CV_8UC1);
  mask(cv::Rect(40, 40, 20, 20)) = cv::Scalar(255);
  return mask;
}

}  // namespace

TEST(ObjectVolume, ContainsWhatWasAddedAndNextToIt)
{
  ObjectVolume volume(0.005);
  EXPECT_TRUE(volume.empty());
  EXPECT_FALSE(volume.contains({ 0, 0, 1 }));
  volume.add(wall(1), patch());
  EXPECT_TRUE(volume.contains({ 0, 0, 1 }));
  EXPECT_TRUE(volume.contains({ 0, 0, 1.006 }));
  EXPECT_FALSE(volume.contains({ 0, 0, 1.02 }));
  EXPECT_FALSE(volume.contains({ 0.1, 0, 1 }));
  EXPECT_NEAR(volume.centroid().x(), 0, 0.003);
  volume.clear();
  EXPECT_TRUE(volume.empty());
}

TEST(ObjectVolume, ForgetsWhatMoreViewsSeeThrough)
{
  ObjectVolume volume(0.005);
  volume.add(wall(1), patch());
  volume.add(wall(2), cv::Mat::zeros(100, 100, CV_8UC1));
  volume.removeContradicted(wall(2), {});
  EXPECT_FALSE(volume.contains({ 0, 0, 1 })) << "one for, one against";
  volume.add(wall(1), patch());
  EXPECT_TRUE(volume.contains({ 0, 0, 1 })) << "two for, one against";
}

TEST(ObjectVolume, ForgetsWhatIsSeenAsPartOfANeighbor)
{
  ObjectVolume volume(0.005);
  volume.add(wall(1), patch());
  ObjectVolume hidden = volume;
  hidden.add(wall(0.5), cv::Mat::zeros(100, 100, CV_8UC1));
  hidden.removeContradicted(wall(0.5), patch());
  EXPECT_TRUE(hidden.contains({ 0, 0, 1 })) << "something stands before it";
  volume.add(wall(1), cv::Mat::zeros(100, 100, CV_8UC1));
  volume.removeContradicted(wall(1), patch());
  EXPECT_FALSE(volume.contains({ 0, 0, 1 }));
}

TEST(ObjectVolume, MeasuresHowSureItIs)
{
  ObjectVolume volume(0.005);
  EXPECT_EQ(volume.meanVotes(wall(1), patch()), 0);
  volume.add(wall(1), patch());
  volume.add(wall(1), patch());
  EXPECT_EQ(volume.meanVotes(wall(1), patch()), 2);
  EXPECT_EQ(volume.meanVotes(wall(2), patch()), 0);
  volume.clearVotes();
  EXPECT_EQ(volume.meanVotes(wall(1), patch()), 0);
  EXPECT_FALSE(volume.contains({ 0, 0, 1 }));
}

TEST(ObjectVolume, KnowsWhereItIsInAView)
{
  ObjectVolume volume(0.005);
  volume.add(wall(1), patch());
  const cv::Rect area = volume.areaInView(wall(1), 0.01);
  EXPECT_NEAR(area.x, 37, 2);
  EXPECT_NEAR(area.width, 25, 3);
  EXPECT_EQ(volume.areaInView(wall(1, 5), 0.01).area(), 0) << "out of view";
  rgbd::Keyframe behind = wall(1);
  behind.T_session_camera.translation().z() = 3;
  EXPECT_EQ(volume.areaInView(behind, 0.01).area(), 0) << "behind the camera";
}

}  // namespace object_modelling::segmentation
