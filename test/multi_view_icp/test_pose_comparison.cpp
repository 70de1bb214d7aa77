#include "object_modelling/multi_view_icp/pose_comparison.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/handheld_trajectory.h"
#include "support/pose_errors.h"
#include "support/synthetic_scene.h"

namespace object_modelling::multi_view_icp
{
namespace
{
/// A box on a table, from an arc of six places.
std::vector<rgbd::View> arc()
{
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 6; ++i)
    poses.push_back(test_support::orbitPose({ 0, 0, 0.08 }, 0.7, 0.15 * i, 0.6));
  return test_support::renderViews(test_support::boxOnTable(), test_support::vgaCamera(), poses);
}

PoseSet truth(const std::vector<rgbd::View>& views)
{
  return { test_support::posesOf(views), Eigen::Vector2d::Zero() };
}

/// Every second one moved along its camera's axes.
PoseSet moved(PoseSet set, const Eigen::Vector3d& by_m)
{
  for (std::size_t i = 1; i < set.T_world_camera.size(); i += 2)
    set.T_world_camera[i] = set.T_world_camera[i] * Eigen::Translation3d(by_m);
  return set;
}
std::vector<PoseScore> compared(const std::vector<rgbd::View>& views, const std::vector<PoseSet>& sets,
                                const PoseComparisonOptions& options = {})
{
  base::JobControl control;
  return comparePoses(views, sets, options, control);
}
}  // namespace

TEST(PoseComparison, StopsWhenCancelled)
{
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(comparePoses(arc(), { truth(arc()) }, {}, control), base::Cancelled);
}

TEST(PoseComparison, PrefersTheTruth)
{
  const std::vector<rgbd::View> views = arc();
  const PoseSet exact = truth(views);
  const std::vector<PoseScore> scores =
      compared(views, { exact, moved(exact, { 0, 0, 0.01 }), moved(exact, { 0, 0, 0.03 }) });
  ASSERT_EQ(scores.size(), 3u);
  EXPECT_GT(scores[0].pair_count, 10);
  EXPECT_EQ(scores[0].pair_count, scores[2].pair_count) << "all are judged on the same pixels";
  EXPECT_LT(2 * scores[0].depth, scores[1].depth);
  EXPECT_LT(scores[1].depth, scores[2].depth);
  EXPECT_LT(scores[0].total(), scores[1].total());
}

TEST(PoseComparison, GrayLevelsTellWhatDepthsDoNot)
{
  // Sideways, most of a table and a box stay where they are.
  const std::vector<rgbd::View> views = arc();
  const PoseSet exact = truth(views);
  const std::vector<PoseScore> scores = compared(views, { exact, moved(exact, { 0.006, 0, 0 }) });
  EXPECT_LT(1.3 * scores[0].gray, scores[1].gray);
}

TEST(PoseComparison, JudgesEachSetWithItsOwnColorOffset)
{
  // Colour three pixels to the right of depth.
  std::vector<rgbd::View> views = arc();
  for (rgbd::View& view : views)
  {
    cv::Mat shifted;
    cv::copyMakeBorder(view.frame.gray, shifted, 0, 0, 3, 0, cv::BORDER_REPLICATE);
    view.frame.gray = shifted.colRange(0, view.frame.gray.cols).clone();
  }
  PoseSet with = truth(views), without = with;
  with.color_offset_px = { 3, 0 };
  const std::vector<PoseScore> scores = compared(views, { with, without });
  EXPECT_LT(scores[0].gray, scores[1].gray);
  EXPECT_EQ(scores[0].depth, scores[1].depth);
}

TEST(PoseComparison, LooksAtTheObjectAloneOnRequest)
{
  std::vector<rgbd::View> views = arc();
  const PoseSet exact = truth(views);
  PoseComparisonOptions options;
  options.object_only = true;
  EXPECT_GT(compared(views, { exact }, options)[0].pair_count, 0);
  for (rgbd::View& view : views)
    view.frame.object_mask.release();
  EXPECT_EQ(compared(views, { exact }, options)[0].pair_count, 0);
}

TEST(PoseComparison, TheSameInputGivesTheSameScores)
{
  const std::vector<rgbd::View> views = arc();
  const PoseSet exact = truth(views);
  const std::vector<PoseScore> one = compared(views, { exact }), again = compared(views, { exact });
  EXPECT_EQ(one[0].depth, again[0].depth);
  EXPECT_EQ(one[0].gray, again[0].gray);
}

TEST(PoseComparison, KnowsNothingOfOneKeyframeOrOfNoImages)
{
  EXPECT_TRUE(compared(arc(), {}).empty());
  EXPECT_EQ(compared({}, { {} })[0].pair_count, 0);
  std::vector<rgbd::View> one = arc();
  one.resize(1);
  EXPECT_EQ(compared(one, { truth(one) })[0].pair_count, 0);
  std::vector<rgbd::View> blind = arc();
  for (rgbd::View& view : blind)
    view.frame.depth_m.release();
  const PoseScore score = compared(blind, { truth(blind) })[0];
  EXPECT_EQ(score.pair_count, 0);
  EXPECT_EQ(score.total(), 0);
}

}  // namespace object_modelling::multi_view_icp
