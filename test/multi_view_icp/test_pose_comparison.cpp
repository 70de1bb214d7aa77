#include "object_modelling/multi_view_icp/pose_comparison.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::multi_view_icp
{
namespace
{
/// A box on a table, from an arc of six places.
std::vector<rgbd::Keyframe> arc()
{
  std::vector<rgbd::Keyframe> keyframes;
  for (int i = 0; i < 6; ++i)
  {
    rgbd::Keyframe keyframe;
    keyframe.id = i;
    keyframe.T_session_camera = test_support::orbitPose({ 0, 0, 0.08 }, 0.7, 0.15 * i, 0.6);
    keyframe.frame =
        test_support::renderFrame(test_support::boxOnTable(), test_support::vgaCamera(), keyframe.T_session_camera);
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

PoseSet truth(const std::vector<rgbd::Keyframe>& keyframes)
{
  PoseSet set;
  for (const rgbd::Keyframe& keyframe : keyframes)
    set.T_session_camera.push_back(keyframe.T_session_camera);
  return set;
}

/// Every second one moved along its camera's axes.
PoseSet moved(PoseSet set, const Eigen::Vector3d& by_m)
{
  for (std::size_t i = 1; i < set.T_session_camera.size(); i += 2)
    set.T_session_camera[i] = set.T_session_camera[i] * Eigen::Translation3d(by_m);
  return set;
}
std::vector<PoseScore> compared(const std::vector<rgbd::Keyframe>& keyframes, const std::vector<PoseSet>& sets,
                                const PoseComparisonOptions& options = {})
{
  base::JobControl control;
  return comparePoses(keyframes, sets, options, control);
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
  const std::vector<rgbd::Keyframe> keyframes = arc();
  const PoseSet exact = truth(keyframes);
  const std::vector<PoseScore> scores =
      compared(keyframes, { exact, moved(exact, { 0, 0, 0.01 }), moved(exact, { 0, 0, 0.03 }) });
  ASSERT_EQ(scores.size(), 3u);
  EXPECT_GT(scores[0].pair_count, 10);
  EXPECT_EQ(scores[0].pair_count, scores[2].pair_count) << "all are judged on the same pixels";
  EXPECT_LT(2 * scores[0].depth, scores[1].depth);
  EXPECT_LT(scores[1].depth, scores[2].depth);
  EXPECT_LT(scores[0].total(), scores[1].total());
}

TEST(PoseComparison, GreyLevelsTellWhatDepthsDoNot)
{
  // Sideways, most of a table and a box stay where they are.
  const std::vector<rgbd::Keyframe> keyframes = arc();
  const PoseSet exact = truth(keyframes);
  const std::vector<PoseScore> scores = compared(keyframes, { exact, moved(exact, { 0.006, 0, 0 }) });
  EXPECT_LT(1.3 * scores[0].gray, scores[1].gray);
}

TEST(PoseComparison, JudgesEachSetWithItsOwnColorOffset)
{
  // Colour three pixels to the right of depth.
  std::vector<rgbd::Keyframe> keyframes = arc();
  for (rgbd::Keyframe& keyframe : keyframes)
  {
    cv::Mat shifted;
    cv::copyMakeBorder(keyframe.frame.gray, shifted, 0, 0, 3, 0, cv::BORDER_REPLICATE);
    keyframe.frame.gray = shifted.colRange(0, keyframe.frame.gray.cols).clone();
  }
  PoseSet with = truth(keyframes), without = with;
  with.color_offset_px = { 3, 0 };
  const std::vector<PoseScore> scores = compared(keyframes, { with, without });
  EXPECT_LT(scores[0].gray, scores[1].gray);
  EXPECT_EQ(scores[0].depth, scores[1].depth);
}

TEST(PoseComparison, LooksAtTheObjectAloneOnRequest)
{
  std::vector<rgbd::Keyframe> keyframes = arc();
  const PoseSet exact = truth(keyframes);
  PoseComparisonOptions options;
  options.object_only = true;
  EXPECT_GT(compared(keyframes, { exact }, options)[0].pair_count, 0);
  for (rgbd::Keyframe& keyframe : keyframes)
    keyframe.frame.object_mask.release();
  EXPECT_EQ(compared(keyframes, { exact }, options)[0].pair_count, 0);
}

TEST(PoseComparison, TheSameInputGivesTheSameScores)
{
  const std::vector<rgbd::Keyframe> keyframes = arc();
  const PoseSet exact = truth(keyframes);
  const std::vector<PoseScore> one = compared(keyframes, { exact }), again = compared(keyframes, { exact });
  EXPECT_EQ(one[0].depth, again[0].depth);
  EXPECT_EQ(one[0].gray, again[0].gray);
}

TEST(PoseComparison, KnowsNothingOfOneKeyframeOrOfNoImages)
{
  EXPECT_TRUE(compared(arc(), {}).empty());
  EXPECT_EQ(compared({}, { {} })[0].pair_count, 0);
  std::vector<rgbd::Keyframe> one = arc();
  one.resize(1);
  EXPECT_EQ(compared(one, { truth(one) })[0].pair_count, 0);
  std::vector<rgbd::Keyframe> blind = arc();
  for (rgbd::Keyframe& keyframe : blind)
    keyframe.frame.depth_m.release();
  const PoseScore score = compared(blind, { truth(blind) })[0];
  EXPECT_EQ(score.pair_count, 0);
  EXPECT_EQ(score.total(), 0);
}

}  // namespace object_modelling::multi_view_icp
