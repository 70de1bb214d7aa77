#include "body_links.h"

#include <cmath>

#include <gtest/gtest.h>

#include "icp_problem.h"
#include "icp_scene.h"
#include "support/pose_errors.h"

// Bodies whose views do not overlap as those of one session do.
namespace object_modelling::multi_view_icp
{
namespace
{
/// So many views from about one side.
std::vector<rgbd::View> viewsFrom(double azimuth_rad, double elevation_rad, int count,
                                  const test_support::SyntheticScene& scene)
{
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i)
    poses.push_back(
        test_support::orbitPose({ 0, 0, 0.08 }, 0.6, azimuth_rad + 0.15 * (i - 0.5 * (count - 1)), elevation_rad));
  return test_support::renderViews(scene, test_support::vgaCamera().scaled(0.5), poses, sensorNoise());
}

class BodyLinks : public ::testing::Test
{
protected:
  BodyLinks()
  {
    options_.start_error_m = 0.003;
    options_.sessions_as_bodies = true;
  }

  void add(const std::vector<rgbd::View>& views, const Eigen::Isometry3d& off = Eigen::Isometry3d::Identity())
  {
    const int session_index = views_.empty() ? 0 : views_.back().session_index + 1;
    for (rgbd::View view : views)
    {
      view.session_index = session_index;
      truth_.push_back(view);
      view.T_world_camera = off * view.T_world_camera;
      views_.push_back(view);
    }
  }
  static Eigen::Isometry3d off()
  {
    geometry::Vector6d motion;
    motion << 0.002, -0.0015, 0.001, 0.003, -0.003, 0.005;
    return geometry::isometryFromVector(motion);
  }
  /// Where the object's middle lies by the last body, against where it is.
  Eigen::Vector3d errorAtObject_m(const std::vector<Eigen::Isometry3d>& T_world_camera) const
  {
    const Eigen::Vector3d middle(0, 0, 0.08);
    return T_world_camera.back() * truth_.back().T_world_camera.inverse() * middle - middle;
  }
  MultiViewIcpResult refine() { return refineByMultiViewIcp(views_, options_, control_); }
  bool stayed(const MultiViewIcpResult& result, std::size_t k) const
  {
    return result.T_world_camera.at(k).matrix() == views_[k].T_world_camera.matrix();
  }

  const test_support::SyntheticScene cans_ = plainScene({ test_support::standingCylinder(0.08, 0.14, 0.09, 0),
                                                          test_support::standingCylinder(0.1, 0.08, -0.05, 0.08),
                                                          test_support::standingCylinder(0.07, 0.1, -0.04, -0.09) });
  const test_support::SyntheticScene box_ = test_support::boxOnTable();
  std::vector<rgbd::View> truth_, views_;
  MultiViewIcpOptions options_;
  base::JobControl control_;
};
}  // namespace

TEST_F(BodyLinks, ArePairsOfDifferentBodiesThatShareSurface)
{
  add(viewsFrom(0, 0.6, 2, cans_));
  add(viewsFrom(0.3, 0.6, 2, cans_), off());
  IcpProblem problem(views_, options_, {}, &control_);
  const std::vector<IcpEdge> links = linksBetweenBodies(views_, problem.views(), options_);
  ASSERT_EQ(links.size(), 4U);
  for (const IcpEdge& link : links)
  {
    EXPECT_NE(views_[link.a].session_index, views_[link.b].session_index);
    EXPECT_GT(link.overlap_ratio, 0.4);
    EXPECT_LE(link.overlap_ratio, 1);
  }
  options_.max_partners = 1;
  EXPECT_LT(linksBetweenBodies(views_, problem.views(), options_).size(), 4U);
}

TEST_F(BodyLinks, NeedMoreThanAFewPoints)
{
  options_.points_per_keyframe = 50;
  add(viewsFrom(0, 0.6, 2, cans_));
  add(viewsFrom(0.3, 0.6, 2, cans_));
  IcpProblem problem(views_, options_, {}, &control_);
  EXPECT_TRUE(linksBetweenBodies(views_, problem.views(), options_).empty());
}

TEST_F(BodyLinks, SurfaceInCommonHoldsBodiesSeenFromVeryDifferentSides)
{
  // The corner of a box, from above and from below: each sees the same three faces, but from farther apart than the
  // views of one session may be to be partners.
  test_support::SyntheticScene corner = plainScene({ test_support::standingBox({ 0.15, 0.15, 0.15 }) });
  corner.has_table = false;
  corner.objects[0].T_world_object =
      Eigen::Translation3d(0, 0, 0.08) *
      Eigen::Quaterniond(geometry::rotationBetween(Eigen::Vector3d::Ones().eval(), Eigen::Vector3d::UnitX().eval()));
  options_.object_only = true;
  options_.max_view_angle_rad = 0.2;
  add(viewsFrom(0, 0.15, 3, corner));
  add(viewsFrom(0, -0.15, 3, corner), off());
  const MultiViewIcpResult result = refine();
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_TRUE(result.left_out.empty());
  EXPECT_FALSE(result.pairs.empty());
  EXPECT_GT(errorAtObject_m(test_support::posesOf(views_)).norm(), 0.0025);
  EXPECT_LT(errorAtObject_m(result.T_world_camera).norm(), 0.0005);
}

TEST_F(BodyLinks, WhatSlidesAlongItselfIsNotMovedByNoise)
{
  // A table and the lids of cans: they hold height and tilt alone.
  add(viewsFrom(0, 0.6, 3, cans_));
  add(viewsFrom(2.2, 0.6, 3, cans_), off());
  const MultiViewIcpResult result = refine();
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Eigen::Vector3d before_m = errorAtObject_m(test_support::posesOf(views_)),
                        after_m = errorAtObject_m(result.T_world_camera);
  EXPECT_GT(std::abs(before_m.z()), 0.0005);
  EXPECT_LT(std::abs(after_m.z()), 0.0002);
  EXPECT_LT((after_m - before_m).head<2>().norm(), 0.0005);
}

TEST_F(BodyLinks, BodiesWithNothingInCommonStayAsTheyAre)
{
  options_.object_only = true;
  add(viewsFrom(0, 0, 3, box_));
  add(viewsFrom(M_PI, 0, 2, box_), off());
  const MultiViewIcpResult result = refine();
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find("different bodies"), std::string::npos);
  EXPECT_EQ(result.left_out.size(), views_.size());
  for (std::size_t k = 0; k < views_.size(); ++k)
    EXPECT_TRUE(stayed(result, k)) << k;
}

TEST_F(BodyLinks, WhatNothingLinksIsLeftOutHoweverLarge)
{
  options_.object_only = true;
  add(viewsFrom(0, 0, 7, box_), off());
  add(viewsFrom(M_PI, 0, 2, box_));
  add(viewsFrom(M_PI, 0.3, 2, box_), off());
  const MultiViewIcpResult result = refine();
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.left_out, (std::vector<int>{ 0, 1, 2, 3, 4, 5, 6 }));
  for (std::size_t k = 0; k < 9; ++k)
    EXPECT_TRUE(stayed(result, k)) << k;
  for (std::size_t k = 9; k < 11; ++k)
    EXPECT_FALSE(stayed(result, k)) << k;
}

TEST_F(BodyLinks, UnsettledBodiesAreLeftWhereTheyFittedBest)
{
  add(viewsFrom(0, 0.6, 3, cans_));
  add(viewsFrom(0.3, 0.6, 3, cans_), off());
  const MultiViewIcpResult settled = refine();
  ASSERT_TRUE(settled.converged) << settled.status.message;
  ASSERT_GT(settled.iterations, 3);
  options_.max_iterations = settled.iterations - 1;
  const MultiViewIcpResult result = refine();
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, settled.iterations - 1);
  EXPECT_GT(result.last_step_m, 0);
  EXPECT_GT(result.last_step_rad, 0);
  EXPECT_LT(errorAtObject_m(result.T_world_camera).norm(), 0.5 * errorAtObject_m(test_support::posesOf(views_)).norm());
}

TEST_F(BodyLinks, OneBodyHasNothingToMoveAgainst)
{
  add(viewsFrom(0, 0.6, 3, cans_));
  const MultiViewIcpResult result = refine();
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(result.left_out.size(), 3U);
}

TEST_F(BodyLinks, ViewsWithoutPointsHaveNothingInCommon)
{
  add(viewsFrom(0, 0.6, 2, cans_));
  add(viewsFrom(0, 0.6, 2, cans_));
  for (rgbd::View& view : views_)
    view.frame.depth_m.setTo(0);
  EXPECT_EQ(refine().status.code, base::StatusCode::NO_RESULT);
}

}  // namespace object_modelling::multi_view_icp
