#include "link_consistency.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
constexpr double DRIFT_RATIO = 0.004;  // of the distance, per edge

std::vector<rgbd::Keyframe> keyframesAt(const std::vector<Eigen::Isometry3d>& poses)
{
  std::vector<rgbd::Keyframe> keyframes(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
  {
    keyframes[i].frame.camera = test_support::vgaCamera();
    keyframes[i].T_session_camera = poses[i];
  }
  return keyframes;
}

/// What both cameras see of some points (session frame), with exact poses.
VerifiedLink linkOf(const std::vector<rgbd::Keyframe>& keyframes, int a, int b,
                    const std::vector<Eigen::Vector3d>& points)
{
  VerifiedLink link;
  link.a = a;
  link.b = b;
  link.T_a_b = keyframes[a].T_session_camera.inverse() * keyframes[b].T_session_camera;
  for (const Eigen::Vector3d& p : points)
  {
    LinkedPoint point;
    const Eigen::Vector3d p_a = keyframes[a].T_session_camera.inverse() * p;
    const Eigen::Vector3d p_b = keyframes[b].T_session_camera.inverse() * p;
    point.pixel_a = keyframes[a].frame.camera.project(p_a);
    point.pixel_b = keyframes[b].frame.camera.project(p_b);
    point.depth_a_m = p_a.z();
    point.depth_b_m = p_b.z();
    point.sigma_a_px = point.sigma_b_px = 0.5;
    link.points.push_back(point);
  }
  return link;
}

const std::vector<Eigen::Vector3d> CROSS = { { 0.1, 0, 0 },  { -0.1, 0, 0 }, { 0, 0.1, 0 },
                                             { 0, -0.1, 0 }, { 0, 0, 0.1 },  { 0, 0, -0.1 } };

void expectPatch(const PoseEdge& edge, const Eigen::Vector3d& center_b, double radius_m)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : edge.points_b)
  {
    sum += p;
    EXPECT_NEAR((p - center_b).norm(), radius_m, 1e-6);
  }
  EXPECT_LT((sum / 4 - center_b).norm(), 1e-6);
  EXPECT_NEAR(edge.sigma_m, DRIFT_RATIO * center_b.norm(), 1e-9);
}

TEST(EdgeOfLink, HasThePatchThatTheSecondKeyframeSees)
{
  const std::vector<rgbd::Keyframe> keyframes = keyframesAt(test_support::orbitPoses(8, { 0, 0, 0 }, 0.5));
  const VerifiedLink link = linkOf(keyframes, 5, 2, CROSS);
  const PoseEdge edge = edgeOfLink(link, keyframes);
  EXPECT_EQ(edge.a, 5);
  EXPECT_EQ(edge.b, 2);
  EXPECT_EQ(edge.T_a_b.matrix(), link.T_a_b.matrix());
  expectPatch(edge, { 0, 0, 0.5 }, 0.1);
}

TEST(EdgeOfLink, HasAPatchOfSomeSizeEvenOfOnePointOrNone)
{
  const std::vector<rgbd::Keyframe> keyframes = keyframesAt(test_support::orbitPoses(8, { 0, 0, 0 }, 0.5));
  expectPatch(edgeOfLink(linkOf(keyframes, 0, 1, { Eigen::Vector3d::Zero() }), keyframes), { 0, 0, 0.5 }, 0.025);
  expectPatch(edgeOfLink(linkOf(keyframes, 0, 1, {}), keyframes), { 0, 0, 1 }, 0.05);
}

TEST(EdgesOfTracker, JoinPairsThatShareEnough)
{
  const std::vector<rgbd::Keyframe> keyframes = keyframesAt(test_support::orbitPoses(8, { 0, 0, 0 }, 0.5));
  // 0, 1 and 2 see the cross; 3 sees two of its points, and of one of them the depth is missing.
  std::vector<SightGroup> groups;
  for (std::size_t i = 0; i < CROSS.size(); ++i)
  {
    SightGroup group;
    for (int k = 0; k < (i < 2 ? 4 : 3); ++k)
    {
      const Eigen::Vector3d p = keyframes[k].T_session_camera.inverse() * CROSS[i];
      Sight sight;
      sight.keyframe = k;
      sight.pixel = keyframes[k].frame.camera.project(p);
      sight.depth_m = k == 3 && i == 1 ? std::nan("") : p.z();
      group.sights.push_back(sight);
    }
    groups.push_back(group);
  }
  const std::vector<PoseEdge> three = edgesOfTracker(groups, keyframes, 3);
  ASSERT_EQ(three.size(), 3u) << "0-1, 0-2, 1-2";
  for (const PoseEdge& edge : three)
  {
    EXPECT_LT(edge.a, edge.b);
    EXPECT_LT(edge.b, 3);
    EXPECT_TRANSFORM_NEAR(edge.T_a_b, keyframes[edge.a].T_session_camera.inverse() * keyframes[edge.b].T_session_camera,
                          1e-12, 1e-7);
    expectPatch(edge, { 0, 0, 0.5 }, 0.1);
  }
  const std::vector<PoseEdge> two = edgesOfTracker(groups, keyframes, 2);
  ASSERT_EQ(two.size(), 6u);
  const Eigen::Vector3d alone = keyframes[3].T_session_camera.inverse() * CROSS[0];
  for (const PoseEdge& edge : two)
    if (edge.b == 3)
      expectPatch(edge, alone, 0.05 * alone.norm());
  EXPECT_TRUE(edgesOfTracker(groups, keyframes, 7).empty());
  EXPECT_TRUE(edgesOfTracker({}, keyframes, 1).empty());
}

/// Cameras in one place that see a patch at 1 m: every edge may be 16 mm off in the end.
class LinksOfAChain : public testing::Test
{
protected:
  static constexpr int COUNT = 4;
  static PoseEdge edge(int a, int b, double off_m)
  {
    PoseEdge result;
    result.a = a;
    result.b = b;
    result.T_a_b.translation().x() = off_m;
    result.points_b = patchCorners(Eigen::Vector3d::UnitZ(), 0.1);
    result.sigma_m = DRIFT_RATIO;
    return result;
  }
  /// Which of the links stay, with the tracker's steps being right.
  std::vector<bool> kept(const std::vector<PoseEdge>& links)
  {
    std::vector<PoseEdge> tracker;
    for (int i = 0; i + 1 < COUNT; ++i)
      tracker.push_back(edge(i, i + 1, 0));
    std::vector<bool> active(links.size(), true);
    if (!links.empty() && first_is_out_)
      active[0] = false;
    relaxed_ = relaxWithLinks(tracker, links, 0, poses_, &active);
    return active;
  }
  std::vector<Eigen::Isometry3d> poses_{ COUNT, Eigen::Isometry3d::Identity() }, relaxed_;
  bool first_is_out_ = false;
};

TEST_F(LinksOfAChain, MayBeOffByTheDriftOfTheLoop)
{
  // Three steps and the link share the error: 4 times 16 mm is the limit.
  EXPECT_EQ(kept({ edge(0, 3, 0.062) }), std::vector<bool>{ true });
  for (int i = 0; i < COUNT; ++i)
    EXPECT_NEAR(relaxed_[i].translation().x(), 0.0155 * i, 1e-4) << "spread";
  EXPECT_EQ(kept({ edge(0, 3, 0.066) }), std::vector<bool>{ false });
  for (const Eigen::Isometry3d& T : relaxed_)
    EXPECT_TRANSFORM_NEAR(T, Eigen::Isometry3d::Identity(), 1e-6, 1e-6);
  // Over one step it is 2 times 16 mm.
  EXPECT_EQ(kept({ edge(1, 2, 0.030) }), std::vector<bool>{ true });
  EXPECT_EQ(kept({ edge(2, 1, 0.034) }), std::vector<bool>{ false });
}

TEST_F(LinksOfAChain, OnlyTheWrongOnesAreDropped)
{
  EXPECT_EQ(kept({ edge(0, 3, 0), edge(0, 2, 0.2), edge(1, 3, 0), edge(0, 3, -0.3), edge(1, 3, 0.01) }),
            (std::vector<bool>{ true, false, true, false, true }));
  EXPECT_LT(relaxed_[3].translation().norm(), 0.005);
}

TEST_F(LinksOfAChain, OneThatWasOutStaysOutAndDoesNotPull)
{
  first_is_out_ = true;
  EXPECT_EQ(kept({ edge(0, 3, 0.03), edge(0, 3, 0) }), (std::vector<bool>{ false, true }));
  EXPECT_TRANSFORM_NEAR(relaxed_[3], Eigen::Isometry3d::Identity(), 1e-6, 1e-6);
  EXPECT_TRUE(kept({}).empty());
}

TEST(LinkSupport, TakesHalfOfThePoints)
{
  const std::vector<rgbd::Keyframe> keyframes = keyframesAt(test_support::orbitPoses(8, { 0, 0, 0 }, 0.5));
  std::vector<Eigen::Isometry3d> poses;
  for (const rgbd::Keyframe& keyframe : keyframes)
    poses.push_back(keyframe.T_session_camera);
  const VerifiedLink link = linkOf(keyframes, 0, 1, CROSS);
  EXPECT_TRUE(supports(link, keyframes, poses));
  VerifiedLink spoilt = link;
  for (int i = 0; i < 3; ++i)
    spoilt.points[i].pixel_a.x() += 100;
  EXPECT_TRUE(supports(spoilt, keyframes, poses)) << "three of six agree";
  spoilt.points[3].depth_b_m += 0.1;
  EXPECT_FALSE(supports(spoilt, keyframes, poses)) << "two of six";
  // The same points, but the pose is off.
  poses[1] = poses[1] * Eigen::Translation3d(0.003, 0, 0);
  EXPECT_TRUE(supports(link, keyframes, poses));
  poses[1] = poses[1] * Eigen::Translation3d(0.05, 0, 0);
  EXPECT_FALSE(supports(link, keyframes, poses));
}

}  // namespace
}  // namespace object_modelling::bundle_adjustment
