#include "icp_equations.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>

#include "icp_problem.h"
#include "icp_scene.h"
#include "icp_system.h"
#include "support/pose_errors.h"
#include "support/transform_matchers.h"

namespace object_modelling::multi_view_icp
{
namespace
{
/// Two views of a printed box on a printed table, b a little off.
class IcpEquationsTest : public ::testing::Test
{
protected:
  IcpEquationsTest()
  {
    views_ = test_support::renderViews(
        test_support::boxOnTable(), test_support::vgaCamera().scaled(0.5),
        { test_support::orbitPose({ 0, 0, 0.1 }, 0.7, 0, 0.6), test_support::orbitPose({ 0, 0, 0.1 }, 0.7, 0.3, 0.5) },
        sensorNoise());
    views_ = test_support::perturbed(views_, 0.002, 0.003);
  }

  std::vector<rgbd::View> views_;
  base::JobControl control_;
};

/// Derivative of f by a motion on the left, by central differences.
template <typename Function>
geometry::Vector6d numericGradient(Function f, double step)
{
  geometry::Vector6d gradient;
  for (int i = 0; i < 6; ++i)
  {
    const geometry::Vector6d motion = step * geometry::Vector6d::Unit(i);
    gradient[i] = (f(geometry::isometryFromVector(motion)) - f(geometry::isometryFromVector(-motion))) / (2 * step);
  }
  return gradient;
}
}  // namespace

TEST_F(IcpEquationsTest, GradientIsThatOfTheCost)
{
  for (const double color_weight : { 0.0, 1.0 })
  {
    MultiViewIcpOptions options;
    options.color_weight = color_weight;
    const IcpView a(views_[0], options), b(views_[1], options);
    const Eigen::Isometry3d T_a_b = views_[0].T_world_camera.inverse() * views_[1].T_world_camera;
    IcpStage stage;
    stage.gate_m = 0.01;
    stage.min_normal_cosine = 0.8;
    const IcpMatches matches = matchViews(a, b, T_a_b, stage, nullptr);
    ASSERT_GT(matches.surface.size(), 500U);
    ASSERT_EQ(matches.color.empty(), color_weight == 0);
    const IcpLoss loss{ options.loss_width_sigmas, color_weight, stage.color_level };
    const IcpEquations equations = icpEquations(a, matches, T_a_b, loss);
    EXPECT_NEAR(equations.cost, icpCost(a, matches, T_a_b, loss), 1e-9 * equations.cost);
    // Bilinear images have kinks at pixel borders, hence the tolerance with colour.
    const geometry::Vector6d numeric = numericGradient(
        [&](const Eigen::Isometry3d& motion) { return icpCost(a, matches, motion * T_a_b, loss); }, 1e-6);
    EXPECT_LT((equations.g - numeric).norm(), (color_weight > 0 ? 0.02 : 1e-5) * numeric.norm());
  }
}

TEST_F(IcpEquationsTest, PairsAreInTheSessionFrame)
{
  const MultiViewIcpOptions options;
  IcpProblem problem(views_, options, { { 0, 1, 1.0 } }, &control_);
  // A session frame away from both cameras, so that frames mixed up would show.
  geometry::Vector6d away;
  away << 0.3, -0.2, 0.5, 0.4, 1.0, -0.3;
  std::vector<Eigen::Isometry3d> poses;
  for (const rgbd::View& view : views_)
    poses.push_back(geometry::isometryFromVector(away) * view.T_world_camera);
  problem.match(poses, { 0.01, 0.8, 0, 1 });
  const std::vector<PairEquations> pairs = problem.equations(poses);
  ASSERT_EQ(pairs.size(), 1U);
  for (const int moved : { 0, 1 })
  {
    const geometry::Vector6d numeric = numericGradient(
        [&](const Eigen::Isometry3d& motion)
        {
          std::vector<Eigen::Isometry3d> at = poses;
          at[moved] = motion * at[moved];
          return problem.cost(at);
        },
        1e-6);
    EXPECT_LT(((moved == 0 ? 1 : -1) * pairs[0].g - numeric).norm(), 0.02 * numeric.norm()) << moved;
  }
}

TEST(IcpSystem, SolvesWhatADenseSolverDoes)
{
  std::srand(5);
  std::vector<PairEquations> pairs;
  for (const auto& [a, b] : std::vector<std::pair<int, int>>{ { 0, 1 }, { 1, 3 }, { 0, 3 }, { 3, 4 } })
  {
    const geometry::Matrix6d root = geometry::Matrix6d::Random();
    pairs.push_back(
        { a, b, 0, root.transpose() * root + geometry::Matrix6d::Identity(), geometry::Vector6d::Random() });
  }
  const std::vector<int> members = { 0, 1, 3, 4 };  // 2 is left out
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(30, 30);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(30);
  for (const PairEquations& pair : pairs)
  {
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(6, 30);
    difference.middleCols<6>(6 * pair.a).setIdentity();
    difference.middleCols<6>(6 * pair.b) -= geometry::Matrix6d::Identity();
    dense += difference.transpose() * pair.A * difference;
    right -= difference.transpose() * pair.g;
  }
  // Fixed: 0 and 2.
  dense.topLeftCorner<6, 6>() += 1e12 * geometry::Matrix6d::Identity();
  dense.block<6, 6>(12, 12) += 1e12 * geometry::Matrix6d::Identity();
  const Eigen::VectorXd expected = dense.ldlt().solve(right);
  const auto motions = solveMotions(pairs, members, { 0, 1, 2, 3, 4 }, 0);
  ASSERT_TRUE(motions);
  EXPECT_TRUE((*motions)[0].isZero());
  EXPECT_TRUE((*motions)[2].isZero());
  for (const int k : { 1, 3, 4 })
    EXPECT_LT(((*motions)[k] - expected.segment<6>(6 * k)).norm(), 1e-6) << k;
  const Eigen::MatrixXd inverse = dense.inverse();
  const auto covariances = motionCovariances(pairs, members, { 0, 1, 2, 3, 4 }, geometry::Matrix6d::Zero());
  for (const int k : { 1, 3, 4 })
    EXPECT_LT((covariances[k] - inverse.block<6, 6>(6 * k, 6 * k)).norm(), 1e-6) << k;
}

TEST(NearestPoints, AreNearest)
{
  const std::vector<rgbd::View> views = viewsRound(plainScene({ test_support::standingSphere(0.16) }), 1);
  const IcpView view(views[0], {});
  const NearestPoints nearest(view);
  for (std::size_t i = 0; i < view.surfacePoints().size(); i += 50)
  {
    const Eigen::Vector3f p = view.surfacePoints()[i].p + Eigen::Vector3f(0.004F, -0.003F, 0.002F);
    float least_m = INFINITY;
    for (int v = 0; v < view.size().height; v += 2)
      for (int u = 0; u < view.size().width; u += 2)
        if (view.has(u, v))
          least_m = std::min(least_m, (view.point(u, v) - p).norm());
    Eigen::Vector3f found, normal;
    ASSERT_TRUE(nearest.find(p, &found, &normal));
    EXPECT_NEAR((found - p).norm(), least_m, 1e-6F);
    EXPECT_NEAR(normal.norm(), 1, 1e-3F);
  }
  Eigen::Vector3f found, normal;
  EXPECT_FALSE(NearestPoints(IcpView({}, {})).find({ 0, 0, 1 }, &found, &normal));
}

TEST(IcpView, PointsAreSpreadOverTheNormals)
{
  const std::vector<rgbd::View> views =
      viewsRound(plainScene({ test_support::standingBox({ 0.08, 0.12, 0.16 }, 0, 0, 0.6) }), 1);
  MultiViewIcpOptions options;
  options.points_per_keyframe = 900;
  const IcpView view(views[0], options);
  EXPECT_LE(view.surfacePoints().size(), 910U);
  EXPECT_GT(view.surfacePoints().size(), 700U);
  int upright = 0;
  for (const IcpPoint& point : view.surfacePoints())
  {
    EXPECT_LT(point.n.dot(point.p), 0);
    upright += (views[0].T_world_camera.linear().cast<float>() * point.n).z() > 0.9F;
  }
  // The table is nine tenths of the picture and has one direction of several.
  EXPECT_LT(upright, 700);
}

TEST(IcpView, TakesGrayLevelsByTheOffsetOfItsView)
{
  constexpr int OFFSET_PX = 4;
  const rgbd::View registered = viewsRound(test_support::boxOnTable(), 1).front();
  rgbd::View shifted = registered;
  cv::Mat wide;
  cv::copyMakeBorder(registered.frame.gray, wide, 0, 0, OFFSET_PX, 0, cv::BORDER_REPLICATE);
  shifted.frame.gray = wide.colRange(0, registered.frame.gray.cols).clone();
  shifted.color_offset_px = { OFFSET_PX, 0 };
  const cv::Mat expected = IcpView(registered, {}).images().front().gray,
                found = IcpView(shifted, {}).images().front().gray;
  const cv::Range inside(0, expected.cols - OFFSET_PX);
  EXPECT_EQ(cv::norm(found.colRange(inside), expected.colRange(inside), cv::NORM_INF), 0);
}

TEST(IcpSystem, NothingToMoveIsNoMotion)
{
  PairEquations pair{ 0, 1, 1.0 };
  pair.A = geometry::Matrix6d::Identity();
  EXPECT_TRUE(solveMotions({ pair }, { 0, 1 }, { 0, 1 }, 1e-4));
  EXPECT_FALSE(solveMotions({}, { 0, 1 }, { 7, 7 }, 1e-4));
  EXPECT_FALSE(solveMotions({}, {}, {}, 1e-4));
  const std::vector<geometry::Matrix6d> covariances =
      motionCovariances({}, { 0, 1 }, { 7, 7 }, geometry::Matrix6d::Identity());
  ASSERT_EQ(covariances.size(), 2U);
  EXPECT_TRUE(covariances[1].isZero());
}

}  // namespace object_modelling::multi_view_icp
