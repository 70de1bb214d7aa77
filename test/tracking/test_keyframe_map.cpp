#include <gtest/gtest.h>

#include "keyframe_map.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::tracking
{
namespace
{
Eigen::Isometry3d orbit(double azimuth_rad, double radius_m = 0.7)
{
  return test_support::orbitPose({ 0, 0, 0.08 }, radius_m, azimuth_rad, 0.6);
}

MapKeyframe keyframe(int id, const Eigen::Isometry3d& T_session_camera, bool trusted = true)
{
  MapKeyframe made;
  made.id = id;
  made.T_session_camera = T_session_camera;
  made.median_depth_m = 0.7;
  made.trusted = trusted;
  made.frame = test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(), T_session_camera);
  return made;
}
}  // namespace

TEST(KeyframeMap, NewViewsDifferInDirectionOrDistance)
{
  KeyframeMap map;
  EXPECT_TRUE(map.isNewView(orbit(0), 0.2, 0.2));
  map.add(keyframe(0, orbit(0)));
  EXPECT_FALSE(map.isNewView(orbit(0), 0.2, 0.2));
  EXPECT_FALSE(map.isNewView(orbit(0.15), 0.2, 0.2));
  EXPECT_TRUE(map.isNewView(orbit(0.4), 0.2, 0.2));
  EXPECT_TRUE(map.isNewView(orbit(0, 1.0), 0.2, 0.2));
}

TEST(KeyframeMap, ComingRoundFindsTheFirstKeyframeAgain)
{
  KeyframeMap map;
  for (int i = 0; i < 12; ++i)
    map.add(keyframe(i, orbit(i * M_PI / 6)));
  const std::vector<const MapKeyframe*> nearest = map.nearestViews(orbit(2 * M_PI + 0.1), 2);
  ASSERT_EQ(nearest.size(), 2u);
  EXPECT_EQ(nearest[0]->id, 0);
  EXPECT_EQ(nearest[1]->id, 1);
}

TEST(KeyframeMap, PrefersTrustedViewsAndRecognisesOnlyThem)
{
  KeyframeMap map;
  map.add(keyframe(0, orbit(0)));
  map.add(keyframe(1, orbit(0.1), false));
  EXPECT_EQ(map.nearestViews(orbit(0.1), 1)[0]->id, 0);
  EXPECT_EQ(map.nearestViews(orbit(0.1), 2).size(), 2u);
  EXPECT_EQ(map.nearestViews(orbit(0.1), 2, true).size(), 1u);
  const std::vector<const MapKeyframe*> similar = map.similarImages(makeThumbnail(map.keyframes()[1]->frame.gray), 5);
  ASSERT_EQ(similar.size(), 1u);
  EXPECT_EQ(similar[0]->id, 0);
}

TEST(KeyframeMap, SimilarImagesAreThoseOfTheSameView)
{
  KeyframeMap map;
  for (int i = 0; i < 8; ++i)
    map.add(keyframe(i, orbit(i * M_PI / 4)));
  const rgbd::Frame frame =
      test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(), orbit(3 * M_PI / 4 + 0.05));
  EXPECT_EQ(map.similarImages(makeThumbnail(frame.gray), 1)[0]->id, 3);
}
TEST(KeyframeMap, KeepsDepthInHalfTheMemoryAndGivesItBack)
{
  MapKeyframe made = keyframe(0, orbit(0));
  const cv::Mat depth_m = made.frame.depth_m.clone();
  made.pyramid = { made.frame.gray.clone() };
  KeyframeMap map;
  const MapKeyframe& added = map.add(std::move(made));
  EXPECT_TRUE(added.frame.color_bgr.empty());
  EXPECT_TRUE(added.frame.depth_m.empty());
  EXPECT_EQ(added.frame.gray.data, added.pyramid.front().data);
  const cv::Mat given_m = added.wholeFrame().depth_m;
  const cv::Mat known = depth_m == depth_m;
  EXPECT_EQ(cv::countNonZero(known != (given_m == given_m)), 0);
  EXPECT_LE(cv::norm(given_m, depth_m, cv::NORM_INF, known), 0.00013);
}

}  // namespace object_modelling::tracking
