#include "object_modelling/source/trajectory_correction.h"

#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::source
{
namespace
{
Eigen::Isometry3d pose(double x, double y, double yaw)
{
  return geometry::isometryFrom(Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), { x, y, 0 });
}

std::vector<source::StampedPose> straightLine()
{
  std::vector<source::StampedPose> line;
  for (int i = 0; i <= 10; ++i)
    line.push_back({ 100 + 0.1 * i, pose(0.01 * i, 0, 0) });
  return line;
}

TEST(TrajectoryCorrection, keepsAnUncorrectedTrajectory)
{
  const std::vector<source::StampedPose> live = straightLine();
  const std::vector<Eigen::Isometry3d> poses{ live[2].T_map_camera, live[8].T_map_camera };
  const auto corrected = correctTrajectory(live, { live[2].stamp_s, live[8].stamp_s }, poses, poses);
  ASSERT_EQ(corrected.size(), live.size());
  for (std::size_t i = 0; i < live.size(); ++i)
  {
    EXPECT_TRUE(corrected[i].T_map_camera.isApprox(live[i].T_map_camera, 1e-12));
    EXPECT_EQ(corrected[i].stamp_s, live[i].stamp_s);
  }
  EXPECT_EQ(correctTrajectory(live, {}, {}, {}).size(), live.size());
  EXPECT_TRUE(correctTrajectory({}, { 1 }, { poses[0] }, { poses[0] }).empty());
}

TEST(TrajectoryCorrection, meetsTheKeyframesAndInterpolatesBetween)
{
  const std::vector<source::StampedPose> live = straightLine();
  const std::vector<Eigen::Isometry3d> before{ live[2].T_map_camera, live[8].T_map_camera };
  const std::vector<Eigen::Isometry3d> after{ pose(0.02, 0, 0), pose(0.08, 0.006, 0) };
  const auto corrected = correctTrajectory(live, { live[2].stamp_s, live[8].stamp_s }, before, after);
  EXPECT_TRUE(corrected[2].T_map_camera.isApprox(after[0], 1e-12));
  EXPECT_TRUE(corrected[8].T_map_camera.isApprox(after[1], 1e-12));
  for (int i = 2; i <= 8; ++i)
    EXPECT_NEAR(corrected[i].T_map_camera.translation().y(), 0.001 * (i - 2), 1e-9);
  EXPECT_NEAR(corrected[0].T_map_camera.translation().y(), 0, 1e-12);
  EXPECT_NEAR(corrected[10].T_map_camera.translation().y(), 0.006, 1e-12);
}

TEST(TrajectoryCorrection, carriesAFrameRigidlyWithItsKeyframe)
{
  const std::vector<source::StampedPose> live{ { 5, pose(0.3, 0.1, 0.2) } };
  const Eigen::Isometry3d before = pose(0.2, 0, 0.1), after = pose(-1, 2, 1.3);
  const auto corrected = correctTrajectory(live, { 4 }, { before }, { after });
  EXPECT_TRUE((after.inverse() * corrected[0].T_map_camera).isApprox(before.inverse() * live[0].T_map_camera, 1e-12));
}

TEST(TrajectoryCorrection, refusesUnmatchedOrUnsortedKeyframes)
{
  const Eigen::Isometry3d I = Eigen::Isometry3d::Identity();
  EXPECT_THROW(correctTrajectory({}, { 1, 2 }, { I }, { I, I }), base::Error);
  EXPECT_THROW(correctTrajectory({}, { 2, 1 }, { I, I }, { I, I }), base::Error);
  EXPECT_THROW(correctTrajectory({}, { 1, 1 }, { I, I }, { I, I }), base::Error);
}

}  // namespace
}  // namespace object_modelling::source
