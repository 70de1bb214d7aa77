#include "object_modelling/alignment/pair_alignment.h"

#include <gtest/gtest.h>

#include "object_modelling/alignment/alignment_by_points.h"
#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/alignment/session_part.h"

#include "object_modelling/geometry/transform.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"
#include "support/violations.h"

namespace object_modelling::alignment
{
namespace
{
const Eigen::Vector3d SIZE_M(0.08, 0.12, 0.2);

/// A session round an object that stands as it is turned; its session frame is the world frame.
registration::PartialModel scanned(const std::string& id, test_support::SceneObject object, const Eigen::Matrix3d& R,
                                   double height_m, bool use_color = true)
{
  object.T_world_object.linear() = R;
  object.T_world_object.translation() = Eigen::Vector3d(0, 0, height_m / 2);
  test_support::SyntheticScene scene;
  scene.table.seed = 7;
  scene.objects = { object };
  test_support::SensorNoise noise;
  noise.depth_sigma_scale = 0.5;
  noise.missing_edge_px = 1;
  noise.max_theta_rad = 1.3;
  const std::vector<Eigen::Isometry3d> poses = test_support::orbitPoses(14, { 0, 0, height_m / 2 }, 0.6);
  keyframes::Session session;
  session.id = id;
  session.support_plane_session = geometry::Plane{ Eigen::Vector3d::UnitZ(), 0 };
  PartialModelOptions options;
  options.use_color = use_color;
  base::JobControl control;
  return makePartialModel(session, test_support::renderKeyframes(scene, test_support::smallCamera(), poses, noise),
                          options, control);
}

Eigen::Matrix3d about(const Eigen::Vector3d& axis, double degrees)
{
  return Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
}

const Eigen::Vector3d X_AXIS = Eigen::Vector3d::UnitX(), Y_AXIS = Eigen::Vector3d::UnitY(),
                      Z_AXIS = Eigen::Vector3d::UnitZ();

/// T_a_b of an object that stood as R_a, and then as R_b.
Eigen::Isometry3d truth(const Eigen::Matrix3d& R_a, double height_a_m, const Eigen::Matrix3d& R_b, double height_b_m)
{
  Eigen::Isometry3d T_a = Eigen::Isometry3d::Identity(), T_b = T_a;
  T_a.linear() = R_a;
  T_a.translation().z() = height_a_m / 2;
  T_b.linear() = R_b;
  T_b.translation().z() = height_b_m / 2;
  return T_a * T_b.inverse();
}

void expectNear(const PairAlignment& found, const Eigen::Isometry3d& T_a_b, double height_b_m)
{
  ASSERT_TRUE(found.accepted) << found.reason;
  const Eigen::Isometry3d off = T_a_b.inverse() * found.candidates.front().T_a_b;
  const Eigen::Vector3d center(0, 0, height_b_m / 2);
  EXPECT_LT(geometry::rotationAngle_rad(off), 1.5 * M_PI / 180);
  EXPECT_LT((off * center - center).norm(), 0.0015);
}

PairAlignment align(const registration::PartialModel& a, const registration::PartialModel& b,
                    const PairAlignmentOptions& options = {})
{
  base::JobControl control;
  return alignPair(a, b, options, control);
}

class PairAlignmentOfABox : public testing::Test
{
protected:
  test_support::SceneObject box_ = test_support::standingBox(SIZE_M);
  Eigen::Matrix3d upright_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d lying_ = about(Z_AXIS, 40) * about(X_AXIS, 90);
};

TEST_F(PairAlignmentOfABox, FindsItLaidOnItsSide)
{
  const registration::PartialModel a = scanned("up", box_, upright_, SIZE_M.z()),
                                   b = scanned("side", box_, lying_, SIZE_M.y());
  const PairAlignment found = align(a, b);
  expectNear(found, truth(upright_, SIZE_M.z(), lying_, SIZE_M.y()), SIZE_M.y());
  EXPECT_GT(found.candidates.front().quality.color_agreement, 0.6);
  EXPECT_LT(found.candidates.front().quality.fsv_ratio, 0.01);
  expectNear(align(b, a), truth(lying_, SIZE_M.y(), upright_, SIZE_M.z()), SIZE_M.z());
}

TEST_F(PairAlignmentOfABox, FindsItTurnedUpsideDown)
{
  const Eigen::Matrix3d down = about(Z_AXIS, -70) * about(Y_AXIS, 180);
  expectNear(align(scanned("up", box_, upright_, SIZE_M.z()), scanned("down", box_, down, SIZE_M.z())),
             truth(upright_, SIZE_M.z(), down, SIZE_M.z()), SIZE_M.z());
}

TEST_F(PairAlignmentOfABox, FindsItInTheSameRestingPoseIfThatMayBe)
{
  const Eigen::Matrix3d turned = about(Z_AXIS, 100);
  const registration::PartialModel a = scanned("up", box_, upright_, SIZE_M.z()),
                                   b = scanned("again", box_, turned, SIZE_M.z());
  PairAlignmentOptions same_pose;
  same_pose.same_pose_probability = 0.5;
  expectNear(align(a, b, same_pose), truth(upright_, SIZE_M.z(), turned, SIZE_M.z()), SIZE_M.z());
  const PairAlignment unasked = align(a, b);
  EXPECT_FALSE(unasked.accepted) << "nobody said that it may not have been turned over";
  EXPECT_NE(unasked.reason.find("not been turned over"), std::string::npos) << unasked.reason;
}

TEST_F(PairAlignmentOfABox, TakesAnyEquivalentPoseWithoutColor)
{
  const PairAlignment found =
      align(scanned("up", box_, upright_, SIZE_M.z(), false), scanned("side", box_, lying_, SIZE_M.y(), false));
  ASSERT_TRUE(found.accepted) << found.reason;
  // Of a box: half turns about its axes.
  const Eigen::Isometry3d off =
      truth(upright_, SIZE_M.z(), lying_, SIZE_M.y()).inverse() * found.candidates.front().T_a_b;
  const Eigen::Matrix3d in_box = lying_.transpose() * off.linear() * lying_;
  EXPECT_LT((in_box.cwiseAbs() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.05) << in_box;
}

TEST_F(PairAlignmentOfABox, RefusesAnotherObject)
{
  const registration::PartialModel a = scanned("box", box_, upright_, SIZE_M.z());
  const registration::PartialModel can =
      scanned("can", test_support::standingCylinder(0.07, 0.11), Eigen::Matrix3d::Identity(), 0.11);
  const PairAlignment found = align(a, can);
  EXPECT_FALSE(found.accepted);
  EXPECT_FALSE(found.reason.empty());
  const test_support::SceneObject other = test_support::standingBox({ 0.08, 0.15, 0.17 }, 0, 0, 0, 9);
  EXPECT_FALSE(align(a, scanned("other", other, upright_, 0.17)).accepted) << "a box of other edges";
}

TEST_F(PairAlignmentOfABox, RefusesAnotherPrintOnTheSameShape)
{
  test_support::SceneObject other = test_support::standingBox(SIZE_M, 0, 0, 0, 77);
  box_.texture.contrast = other.texture.contrast = 1;
  box_.texture.color_bgr = { 60, 90, 170 };
  const PairAlignment found =
      align(scanned("box", box_, upright_, SIZE_M.z()), scanned("other", other, lying_, SIZE_M.y()));
  EXPECT_FALSE(found.accepted);
  EXPECT_FALSE(found.reason.empty());
}

TEST_F(PairAlignmentOfABox, GivesTheSameBitsWithAnyNumberOfThreads)
{
  const registration::PartialModel a = scanned("up", box_, upright_, SIZE_M.z()),
                                   b = scanned("side", box_, lying_, SIZE_M.y());
  PairAlignmentOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const PairAlignment first = align(a, b, one), second = align(a, b, three);
  ASSERT_EQ(first.candidates.size(), second.candidates.size());
  for (std::size_t i = 0; i < first.candidates.size(); ++i)
    EXPECT_EQ(first.candidates[i].T_a_b.matrix(), second.candidates[i].T_a_b.matrix()) << i;
}

TEST_F(PairAlignmentOfABox, TakesAKnownPoseOverWhereThePartsBearItOut)
{
  std::vector<registration::PartialModel> parts = { scanned("up", box_, upright_, SIZE_M.z()),
                                                    scanned("side", box_, lying_, SIZE_M.y()) };
  PairAlignmentOptions hardly;  // one proposal that is not the pose, so that only what is known can be found
  hardly.rotations = 0;
  hardly.refined_candidates = 1;
  for (registration::PartialModel& part : parts)
  {
    part.features.clear();
    part.support_plane.reset();
  }
  base::JobControl control;
  ASSERT_FALSE(alignSessions(parts, {}, hardly, control).status.ok());

  const Eigen::Isometry3d T_a_b = truth(upright_, SIZE_M.z(), lying_, SIZE_M.y());
  AlignmentEdge known;
  known.session_a = "side";
  known.session_b = "up";
  known.accepted = true;
  known.candidates.resize(1);
  known.candidates[0].T_a_b = Eigen::Translation3d(0.001, 0, -0.001) * T_a_b.inverse();
  const AlignmentResult found = alignSessions(parts, { known }, hardly, control);
  ASSERT_TRUE(found.status.ok()) << found.status.message;
  EXPECT_EQ(found.edges[0].session_a, "side");
  EXPECT_TRUE(found.placements[1].T_reference_session.isApprox(T_a_b, 0.01)) << "moved into place";
  EXPECT_GT(found.edges[0].candidates[0].quality.overlap_ratio, 0.3) << "measured again";

  known.candidates[0].T_a_b.translation().x() += 0.05;
  EXPECT_FALSE(alignSessions(parts, { known }, hardly, control).status.ok()) << "the parts do not bear it out";
  known.decision = Decision::ACCEPTED;
  EXPECT_TRUE(alignSessions(parts, { known }, hardly, control).status.ok()) << "a person's word stands";
}

class PointsOfABox : public PairAlignmentOfABox
{
protected:
  /// As a person clicks: corners of the box, each some millimetres off.
  std::vector<PointPair> clicked(int count) const
  {
    const Eigen::Vector3d half = SIZE_M / 2, up(0, 0, SIZE_M.z() / 2), side(0, 0, SIZE_M.y() / 2);
    const std::vector<Eigen::Vector3d> corners = { { 1, 1, 1 }, { -1, 1, 1 }, { 1, 1, -1 }, { -1, 1, -1 } };
    std::vector<PointPair> pairs;
    for (int i = 0; i < count; ++i)
    {
      const Eigen::Vector3d p = corners[i].cwiseProduct(half);
      pairs.push_back({ up + p + Eigen::Vector3d(0.003, -0.002 * i, 0.001), side + lying_ * p });
    }
    return pairs;
  }
  std::string refusal(const std::vector<PointPair>& pairs)
  {
    try
    {
      base::JobControl control;
      alignByPoints(a_, b_, pairs, {}, control);
    }
    catch (const base::Error& error)
    {
      EXPECT_EQ(error.code(), base::StatusCode::INVALID_ARGUMENT);
      return error.what();
    }
    return "accepted";
  }
  registration::PartialModel a_ = scanned("up", box_, upright_, SIZE_M.z()),
                             b_ = scanned("side", box_, lying_, SIZE_M.y());
};

TEST_F(PointsOfABox, TellThePose)
{
  for (const int count : { 3, 4 })
  {
    base::JobControl control;
    const PairCandidate found = alignByPoints(a_, b_, clicked(count), {}, control);
    EXPECT_EQ(found.kind, ProposalKind::BY_HAND);
    expectNear({ true, "", { found } }, truth(upright_, SIZE_M.z(), lying_, SIZE_M.y()), SIZE_M.y());
    EXPECT_GT(found.quality.overlap_ratio, 0.3);
  }
}

TEST_F(PointsOfABox, AreRefusedWhereTheyTellNone)
{
  EXPECT_NE(refusal(clicked(2)).find("2 pairs"), std::string::npos);
  std::vector<PointPair> swapped = clicked(3);
  std::swap(swapped[0].a, swapped[1].a);
  std::swap(swapped[0].b, swapped[2].b);
  EXPECT_NE(refusal(swapped).find("do not fit each other"), std::string::npos) << refusal(swapped);
  std::vector<PointPair> line = clicked(3);
  line[2] = { (line[0].a + line[1].a) / 2, (line[0].b + line[1].b) / 2 };
  EXPECT_NE(refusal(line).find("one line"), std::string::npos) << refusal(line);
  std::vector<PointPair> nan = clicked(3);
  nan[1].b.x() = std::nan("");
  EXPECT_NE(refusal(nan).find("not finite"), std::string::npos) << refusal(nan);
}

TEST_F(PairAlignmentOfABox, StopsWhenCancelled)
{
  const registration::PartialModel a = scanned("up", box_, upright_, SIZE_M.z(), false);
  base::JobControl control;
  control.cancel();
  EXPECT_THROW(alignPair(a, a, {}, control), base::Cancelled);
}

TEST(PairAlignmentOptions, AreChecked)
{
  PairAlignmentOptions options;
  EXPECT_TRUE(options.violations().empty());
  options.threads = 0;
  options.min_probability = 2;
  EXPECT_EQ(test_support::namesOf(options.violations()), (std::vector<std::string>{ "min_probability", "threads" }));
}

}  // namespace
}  // namespace object_modelling::alignment
