#include "object_modelling/multi_view_icp/multi_view_icp.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "icp_scene.h"
#include "support/pose_errors.h"
#include "support/transform_matchers.h"
#include "support/violations.h"

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr double OFF_M = 0.005, OFF_RAD = 0.035;  // 5 mm, 2 deg
constexpr int VIEWS = 12;

/// Three cans without texture on a plain table, seen from all sides. (Not a box: views of one side and of the opposite
/// one have nothing in common that says how wide it is.)
class MultiViewIcp : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    truth_ = viewsRound(plainScene({ test_support::standingCylinder(0.08, 0.14, 0.09, 0),
                                     test_support::standingCylinder(0.1, 0.08, -0.05, 0.08),
                                     test_support::standingCylinder(0.07, 0.1, -0.04, -0.09) }),
                        VIEWS);
  }
  static void TearDownTestSuite() { truth_.clear(); }

  void expectBack(const MultiViewIcpResult& result, double meters = 0.0025, double radians = 0.0035) const
  {
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_TRUE(result.left_out.empty());
    const test_support::PoseError error = test_support::largestError(result.T_world_camera, truth_);
    EXPECT_LT(error.translation_m, meters);
    EXPECT_LT(error.rotation_rad, radians);
  }
  MultiViewIcpResult refine(const std::vector<rgbd::View>& views)
  {
    return refineByMultiViewIcp(views, options_, control_);
  }

  static std::vector<rgbd::View> truth_;
  MultiViewIcpOptions options_;
  base::JobControl control_;
};
std::vector<rgbd::View> MultiViewIcp::truth_;
}  // namespace

TEST_F(MultiViewIcp, BringsDisturbedViewsBackWithoutTexture)
{
  for (const unsigned seed : { 3U, 4U })
    expectBack(refine(test_support::perturbed(truth_, OFF_M, OFF_RAD, seed)));
}

TEST_F(MultiViewIcp, StaysWhereAllIsRight)
{
  expectBack(refine(truth_));
}

TEST_F(MultiViewIcp, ComesBackFromEitherSide)
{
  for (const double sign : { 1.0, -1.0 })
  {
    geometry::Vector6d off;
    off << 0.003, -0.003, 0.003, 0.02, 0.02, -0.02;
    std::vector<rgbd::View> views = truth_;
    views[5].T_world_camera = views[5].T_world_camera * geometry::isometryFromVector(sign * off);
    expectBack(refine(views));
  }
}

TEST_F(MultiViewIcp, ReportsWhatItDid)
{
  const MultiViewIcpResult result = refine(test_support::perturbed(truth_, OFF_M, OFF_RAD));
  ASSERT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, static_cast<int>(result.rmse_m.size()));
  EXPECT_LT(result.rmse_m.back(), 0.5 * result.rmse_m.front());
  ASSERT_EQ(result.residuals.size(), truth_.size());
  for (std::size_t k = 0; k < truth_.size(); ++k)
  {
    const IcpViewResidual& residual = result.residuals[k];
    EXPECT_GT(residual.point_count, 1000);
    EXPECT_GT(residual.inlier_ratio, 0.8);
    EXPECT_LT(residual.rmse_after_m, 0.003);
    EXPECT_LT(residual.rmse_after_m, residual.rmse_before_m);
  }
  std::vector<int> partners(truth_.size(), 0);
  for (const IcpPair& pair : result.pairs)
  {
    ASSERT_LT(pair.view_a, pair.view_b);
    EXPECT_GE(pair.overlap_ratio, options_.min_overlap_ratio);
    EXPECT_LE(pair.overlap_ratio, 1);
    ++partners[pair.view_a];
    ++partners[pair.view_b];
  }
  EXPECT_GE(*std::min_element(partners.begin(), partners.end()), 2);
  EXPECT_TRUE(result.free_directions.empty());
}

TEST_F(MultiViewIcp, CovarianceIsThatOfTheErrors)
{
  const MultiViewIcpResult result = refine(test_support::perturbed(truth_, OFF_M, OFF_RAD));
  ASSERT_TRUE(result.status.ok());
  EXPECT_TRUE(result.covariance.front().isZero());
  double sum = 0;
  for (std::size_t k = 1; k < truth_.size(); ++k)
  {
    const geometry::Vector6d error =
        geometry::vectorFromIsometry(truth_[k].T_world_camera * result.T_world_camera[k].inverse());
    const Eigen::LLT<geometry::Matrix6d> llt(result.covariance[k]);
    ASSERT_EQ(llt.info(), Eigen::Success) << k;
    sum += error.dot(llt.solve(error));
  }
  const double mean = sum / static_cast<double>(truth_.size() - 1);  // 6 if errors are as large as they claim
  EXPECT_GT(mean, 0.2);
  EXPECT_LT(mean, 20);
}

TEST_F(MultiViewIcp, SameBitsOnAnyNumberOfThreads)
{
  const std::vector<rgbd::View> views = test_support::perturbed(truth_, OFF_M, OFF_RAD);
  options_.threads = 1;
  const MultiViewIcpResult one = refine(views);
  for (const int threads : { 2, 5 })
  {
    options_.threads = threads;
    const MultiViewIcpResult several = refine(views);
    EXPECT_EQ(one.rmse_m, several.rmse_m);
    for (std::size_t k = 0; k < views.size(); ++k)
    {
      EXPECT_EQ(one.T_world_camera[k].matrix(), several.T_world_camera[k].matrix()) << k;
      EXPECT_EQ(one.covariance[k], several.covariance[k]) << k;
    }
  }
}

TEST_F(MultiViewIcp, NearestPointsDoAsWell)
{
  options_.association = IcpAssociation::NEAREST;
  expectBack(refine(test_support::perturbed(truth_, OFF_M, OFF_RAD)));
}

TEST_F(MultiViewIcp, AlignsSessionsInOneFrame)
{
  // Every other view is of a second session, which was placed a little wrong as a whole.
  std::vector<rgbd::View> views = truth_;
  geometry::Vector6d off;
  off << 0.006, -0.004, 0.003, 0.01, -0.01, 0.03;
  for (std::size_t k = 1; k < views.size(); k += 2)
  {
    views[k].session_index = 1;
    views[k].T_world_camera = geometry::isometryFromVector(off) * views[k].T_world_camera;
  }
  expectBack(refine(views));
}

TEST_F(MultiViewIcp, MovesBodiesAsAWhole)
{
  options_.sessions_as_bodies = true;
  std::vector<rgbd::View> views = truth_;
  geometry::Vector6d off;
  off << 0.006, -0.004, 0.003, 0.01, -0.01, 0.03;
  for (std::size_t k = 0; k < views.size(); ++k)
  {
    views[k].session_index = static_cast<int>(k % 2);
    if (k % 2 == 1)
      views[k].T_world_camera = geometry::isometryFromVector(off) * views[k].T_world_camera;
  }
  const MultiViewIcpResult result = refine(views);
  expectBack(result);
  for (std::size_t k = 2; k < views.size(); ++k)
  {
    const Eigen::Isometry3d was = views[k % 2].T_world_camera.inverse() * views[k].T_world_camera;
    const Eigen::Isometry3d is = result.T_world_camera[k % 2].inverse() * result.T_world_camera[k];
    EXPECT_TRUE(is.isApprox(was, 1e-9)) << k;
  }
}

TEST_F(MultiViewIcp, CancelledThrows)
{
  for (const std::string stage : { "overlap", "surfaces", "multi-view icp" })
  {
    base::JobControl* running = nullptr;
    base::JobControl control(
        [&](const base::Progress& progress)
        {
          if (progress.stage == stage)
            running->cancel();
        });
    running = &control;
    EXPECT_THROW(refineByMultiViewIcp(truth_, options_, control), base::Cancelled) << stage;
  }
}

TEST_F(MultiViewIcp, StopsAtTheLastIteration)
{
  options_.max_iterations = 2;
  const std::vector<rgbd::View> views = test_support::perturbed(truth_, OFF_M, OFF_RAD);
  const MultiViewIcpResult result = refine(views);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_NE(result.status.message.find("max_iterations"), std::string::npos);
  EXPECT_EQ(result.iterations, 2);
  for (std::size_t k = 0; k < views.size(); ++k)
    EXPECT_EQ(result.T_world_camera[k].matrix(), views[k].T_world_camera.matrix());
}

TEST_F(MultiViewIcp, LeavesOutWhatSeesNothingOfTheRest)
{
  std::vector<rgbd::View> views = test_support::perturbed(truth_, OFF_M, OFF_RAD);
  views[3].frame.depth_m =
      cv::Mat(views[3].frame.depth_m.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  views[7].T_world_camera.translation() += Eigen::Vector3d(30, 0, 0);
  views[9].frame = {};
  const MultiViewIcpResult result = refine(views);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.left_out, (std::vector<int>{ 3, 7, 9 }));
  for (const int k : result.left_out)
    EXPECT_EQ(result.T_world_camera[k].matrix(), views[k].T_world_camera.matrix());
}

TEST_F(MultiViewIcp, LeavesOutWhatDoesNotFit)
{
  std::vector<rgbd::View> views = truth_;
  test_support::SyntheticScene other;
  other.objects = { test_support::standingBox({ 0.3, 0.3, 0.25 }, 0.1, 0.1),
                    test_support::standingCylinder(0.2, 0.3, -0.2) };
  other.has_table = false;
  views[4].frame = test_support::renderFrame(other, views[4].frame.camera, views[4].T_world_camera, sensorNoise());
  const MultiViewIcpResult result = refine(views);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.left_out, std::vector<int>{ 4 });
  EXPECT_EQ(result.T_world_camera[4].matrix(), views[4].T_world_camera.matrix());
  views[4].T_world_camera = result.T_world_camera[4];
  const test_support::PoseError error = test_support::largestError(result.T_world_camera, truth_);
  EXPECT_LT(error.translation_m, 0.0025);
}

TEST_F(MultiViewIcp, NothingToAlign)
{
  EXPECT_EQ(refine({}).status.code, base::StatusCode::NO_RESULT);
  const MultiViewIcpResult one = refine({ truth_.front() });
  EXPECT_EQ(one.status.code, base::StatusCode::NO_RESULT);
  ASSERT_EQ(one.T_world_camera.size(), 1U);
  EXPECT_EQ(one.T_world_camera[0].matrix(), truth_[0].T_world_camera.matrix());

  std::vector<rgbd::View> unmasked = truth_;
  for (rgbd::View& view : unmasked)
    view.frame.object_mask.release();
  options_.object_only = true;
  const MultiViewIcpResult result = refine(unmasked);
  EXPECT_EQ(result.status.code, base::StatusCode::NO_RESULT);
  EXPECT_EQ(result.left_out.size(), truth_.size());
}

TEST_F(MultiViewIcp, WorksOnTheMasksAlone)
{
  const std::vector<rgbd::View> printed = viewsRound(test_support::boxOnTable(), VIEWS);
  options_.object_only = true;
  const MultiViewIcpResult result = refine(test_support::perturbed(printed, OFF_M, OFF_RAD));
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_LT(test_support::largestError(result.T_world_camera, printed).translation_m, 0.008);
  for (std::size_t k = 0; k < printed.size(); ++k)
  {
    const Eigen::Vector3d p(0, 0, 0.1);
    const Eigen::Isometry3d off = printed[k].T_world_camera * result.T_world_camera[k].inverse();
    EXPECT_LT((off * p - p).norm(), 0.002) << k;
  }
}

TEST_F(MultiViewIcp, WidthOfABoxSeenFromAllSidesIsNotKnown)
{
  const std::vector<rgbd::View> box =
      viewsRound(plainScene({ test_support::standingBox({ 0.08, 0.12, 0.16 }) }), VIEWS);
  options_.color_weight = 0;
  const MultiViewIcpResult result = refine(box);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_FALSE(result.free_directions.empty());
  for (const FreeDirection& free : result.free_directions)
  {
    // Along the table, straight or round a far axis; not off it.
    const double upright = std::abs(free.axis_world.z());
    EXPECT_TRUE(free.rotation ? upright > 0.9 : upright < 0.2) << upright;
  }
}

TEST_F(MultiViewIcp, RefusesBadOptions)
{
  options_.threads = 0;
  options_.start_error_m = -1;
  EXPECT_EQ(test_support::namesOf(options_.violations()), (std::vector<std::string>{ "start_error_m", "threads" }));
  EXPECT_THROW(refine(truth_), base::Error);
}

TEST(MultiViewIcpFreedom, AxisOfASphereOnATableIsNamed)
{
  const std::vector<rgbd::View> truth =
      viewsRound(plainScene({ test_support::standingSphere(0.16, 0.03, -0.02) }), VIEWS);
  base::JobControl control;
  const MultiViewIcpResult result = refineByMultiViewIcp(truth, {}, control);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  ASSERT_EQ(result.free_directions.size(), truth.size() - 1);
  for (const FreeDirection& free : result.free_directions)
  {
    EXPECT_TRUE(free.rotation);
    EXPECT_GT(std::abs(free.axis_world.z()), 0.99);
    EXPECT_NEAR(free.point_on_axis_world.x(), 0.03, 0.05);
    EXPECT_NEAR(free.point_on_axis_world.y(), -0.02, 0.05);
  }
}

TEST(MultiViewIcpFreedom, PrintHoldsWhatTheShapeLeavesFree)
{
  test_support::SyntheticScene scene = plainScene({ test_support::standingCylinder(0.1, 0.14) });
  scene.table.contrast = 0.5F;
  std::vector<rgbd::View> truth = viewsRound(scene, VIEWS);
  for (std::size_t k = 0; k < truth.size(); k += 3)
    truth[k].frame.gray = 0.85 * truth[k].frame.gray + 10;  // another exposure
  base::JobControl control;
  MultiViewIcpOptions options;
  const MultiViewIcpResult with =
      refineByMultiViewIcp(test_support::perturbed(truth, OFF_M, OFF_RAD), options, control);
  ASSERT_TRUE(with.status.ok()) << with.status.message;
  EXPECT_TRUE(with.free_directions.empty());
  EXPECT_LT(test_support::largestError(with.T_world_camera, truth).translation_m, 0.002);
  options.color_weight = 0;
  const MultiViewIcpResult without =
      refineByMultiViewIcp(test_support::perturbed(truth, OFF_M, OFF_RAD), options, control);
  ASSERT_TRUE(without.status.ok()) << without.status.message;
  EXPECT_EQ(without.free_directions.size(), truth.size() - 1);
}

}  // namespace object_modelling::multi_view_icp
