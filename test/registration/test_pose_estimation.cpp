#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "object_modelling/registration/pose_estimation.h"
#include "support/synthetic_scene.h"
#include "support/transform_matchers.h"

namespace object_modelling::registration
{
namespace
{
constexpr double MISSING = std::numeric_limits<double>::quiet_NaN();

Eigen::Isometry3d truth()
{
  geometry::Vector6d motion;
  motion << 0.2, -0.1, 0.15, 0.2, -0.3, 0.1;
  return geometry::isometryFromVector(motion);
}

/// Points in view of the true camera, seen with noise.
std::vector<Correspondence> correspondences(int count, double pixel_sigma_px, double depth_sigma_m,
                                            std::uint64_t seed = 3)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal(0, 1);
  const geometry::PinholeCamera camera = test_support::vgaCamera();
  std::vector<Correspondence> result;
  for (int i = 0; i < count; ++i)
  {
    const Eigen::Vector2d pixel(20 + 600 * uniform(generator), 20 + 440 * uniform(generator));
    const double z_m = 0.5 + 0.8 * uniform(generator);
    const Eigen::Vector3d p_session = truth() * camera.unproject(pixel.x(), pixel.y(), z_m);
    result.push_back({ p_session, pixel + pixel_sigma_px * Eigen::Vector2d(normal(generator), normal(generator)),
                       z_m + depth_sigma_m * normal(generator) });
  }
  return result;
}

void spoil(std::vector<Correspondence>* correspondences, double share)
{
  std::mt19937_64 generator(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(correspondences->size()));
  for (std::size_t i = 0; i < count; ++i)
  {
    (*correspondences)[i].pixel = { 640 * uniform(generator), 480 * uniform(generator) };
    (*correspondences)[i].depth_m = 0.4 + 2 * uniform(generator);
  }
}
}  // namespace

TEST(PoseEstimation, IsExactWithoutNoise)
{
  const PoseEstimate found =
      estimatePose(correspondences(60, 0, 0), test_support::vgaCamera(), Eigen::Isometry3d::Identity(), 1, {});
  ASSERT_TRUE(found.valid);
  EXPECT_EQ(found.inlier_count, 60);
  EXPECT_TRANSFORM_NEAR(found.T_world_camera, truth(), 1e-6, 1e-6);
}

TEST(PoseEstimation, SurvivesHalfOutliersFromAFarPrior)
{
  std::vector<Correspondence> data = correspondences(200, 0.4, 0.001);
  spoil(&data, 0.5);
  const PoseEstimate found = estimatePose(data, test_support::vgaCamera(), Eigen::Isometry3d::Identity(), 1, {});
  ASSERT_TRUE(found.valid);
  EXPECT_TRANSFORM_NEAR(found.T_world_camera, truth(), 0.001, 0.001);
  for (std::size_t i = 100; i < 200; ++i)
    EXPECT_TRUE(found.inliers[i]) << i;
  EXPECT_LT(found.inlier_count, 106);
}

TEST(PoseEstimation, NeedsNoDepthInTheCurrentFrameNearThePrior)
{
  std::vector<Correspondence> data = correspondences(100, 0.3, 0);
  for (Correspondence& correspondence : data)
    correspondence.depth_m = MISSING;
  geometry::Vector6d off;
  off << 0.003, -0.002, 0.002, 0.002, 0.001, -0.002;
  const PoseEstimate found =
      estimatePose(data, test_support::vgaCamera(), geometry::isometryFromVector(off) * truth(), 1, {});
  ASSERT_TRUE(found.valid);
  EXPECT_TRANSFORM_NEAR(found.T_world_camera, truth(), 0.0015, 0.0015);
}

TEST(PoseEstimation, IgnoresDepthsThatContradict)
{
  std::vector<Correspondence> data = correspondences(100, 0.3, 0.001);
  for (std::size_t i = 0; i < 30; ++i)
    data[i].depth_m += 0.1;
  const PoseEstimate found = estimatePose(data, test_support::vgaCamera(), Eigen::Isometry3d::Identity(), 1, {});
  ASSERT_TRUE(found.valid);
  EXPECT_TRANSFORM_NEAR(found.T_world_camera, truth(), 0.001, 0.001);
}

TEST(PoseEstimation, RefusesDegenerateInput)
{
  const geometry::PinholeCamera camera = test_support::vgaCamera();
  EXPECT_FALSE(estimatePose({}, camera, truth(), 1, {}).valid);
  EXPECT_FALSE(estimatePose(correspondences(3, 0, 0), camera, truth(), 1, {}).valid);
  const std::vector<Correspondence> same(50, correspondences(1, 0, 0)[0]);
  EXPECT_FALSE(estimatePose(same, camera, truth(), 1, {}).valid);
  std::vector<Correspondence> random = correspondences(100, 0, 0);
  spoil(&random, 1.0);
  const PoseEstimate found = estimatePose(random, camera, Eigen::Isometry3d::Identity(), 1, {});
  EXPECT_LT(found.inlier_count, 15);
}

TEST(PoseEstimation, SameSeedSameBytes)
{
  std::vector<Correspondence> data = correspondences(150, 0.5, 0.002);
  spoil(&data, 0.4);
  const PoseEstimate a = estimatePose(data, test_support::vgaCamera(), Eigen::Isometry3d::Identity(), 7, {});
  const PoseEstimate b = estimatePose(data, test_support::vgaCamera(), Eigen::Isometry3d::Identity(), 7, {});
  EXPECT_EQ(a.T_world_camera.matrix(), b.T_world_camera.matrix());
  EXPECT_EQ(a.covariance, b.covariance);
}

/// The spread of estimates over many draws of the noise is what the covariance says (left perturbation, x y z rx ry
/// rz).
TEST(PoseEstimation, CovarianceMatchesTheSpread)
{
  constexpr int DRAWS = 60;
  geometry::Matrix6d spread = geometry::Matrix6d::Zero();
  geometry::Matrix6d predicted = geometry::Matrix6d::Zero();
  for (int draw = 0; draw < DRAWS; ++draw)
  {
    const PoseEstimate found =
        refinePose(correspondences(80, 0.5, 0.0015, 100 + draw), test_support::vgaCamera(), truth(), {});
    ASSERT_TRUE(found.valid);
    const geometry::Vector6d error =
        geometry::vectorFromIsometry(found.T_world_camera * truth().inverse(Eigen::Isometry));
    spread += error * error.transpose() / DRAWS;
    predicted += found.covariance / DRAWS;
  }
  for (int axis = 0; axis < 6; ++axis)
  {
    EXPECT_GT(std::sqrt(spread(axis, axis) / predicted(axis, axis)), 0.6) << axis;
    EXPECT_LT(std::sqrt(spread(axis, axis) / predicted(axis, axis)), 1.6) << axis;
  }
}
}  // namespace object_modelling::registration
