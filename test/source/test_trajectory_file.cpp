#include "object_modelling/source/trajectory_file.h"

#include <gtest/gtest.h>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"
#include "support/handheld_trajectory.h"
#include "support/temp_dir.h"
#include "support/transform_matchers.h"

namespace object_modelling::source
{
namespace
{
using test_support::TempDir;

std::vector<StampedPose> readText(const std::string& text)
{
  const TempDir dir;
  base::writeTextFile(dir.path("t.txt"), text);
  return readTrajectory(dir.path("t.txt"));
}

TEST(TrajectoryFile, RoundTrip)
{
  const TempDir dir;
  std::vector<StampedPose> written;
  for (const test_support::StampedCamera& camera : test_support::handheldTrajectory())
    written.push_back({ camera.stamp_s, camera.T_world_camera });
  writeTrajectory(dir.path("t.txt"), written);
  const std::vector<StampedPose> read = readTrajectory(dir.path("t.txt"));
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i)
  {
    EXPECT_NEAR(read[i].stamp_s, written[i].stamp_s, 1e-6);
    EXPECT_TRANSFORM_NEAR(read[i].T_map_camera, written[i].T_map_camera, 1e-8, 1e-8);
  }
}

TEST(TrajectoryFile, KnownLine)
{
  const TempDir dir;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(1, -2, 0.5)).rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  writeTrajectory(dir.path("t.txt"), { { 1305031233.861613, T } });
  EXPECT_EQ(base::readTextFile(dir.path("t.txt")),
            "# timestamp tx ty tz qx qy qz qw (T_map_camera)\n"
            "1305031233.861613 1.000000000 -2.000000000 0.500000000 0.000000000 0.000000000 0.707106781 0.707106781\n");
}

TEST(TrajectoryFile, EmptyTrajectoryIsAFileWithAHeader)
{
  const TempDir dir;
  writeTrajectory(dir.path("t.txt"), {});
  EXPECT_TRUE(readTrajectory(dir.path("t.txt")).empty());
}

TEST(TrajectoryFile, RoundedQuaternionIsNormalized)
{
  const std::vector<StampedPose> poses = readText("1 0 0 0 0 0 0.7071 0.7072\r\n");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR(poses[0].T_map_camera.linear().determinant(), 1, 1e-12);
}

TEST(TrajectoryFile, RefusesMalformedLines)
{
  for (const char* text : { "1 2 3\n", "1 0 0 0 0 0 0 x\n", "1 0 0 0 0 0 0 0\n", "1 0 0 0 nan 0 0 1\n",
                            "1 0 0 0 5 5 5 5\n", "\x89PNG\r\n\x1a\n" })
  {
    try
    {
      readText(text);
      FAIL() << "accepted " << text;
    }
    catch (const base::Error& error)
    {
      EXPECT_EQ(error.code(), base::StatusCode::BAD_INPUT) << text;
      EXPECT_NE(std::string(error.what()).find("t.txt:1"), std::string::npos) << error.what();
    }
  }
}

TEST(TrajectoryFile, MissingFileAndFolder)
{
  const TempDir dir;
  EXPECT_THROW(readTrajectory(dir.path("none.txt")), base::Error);
  EXPECT_THROW(writeTrajectory(dir.path("none/t.txt"), {}), base::Error);
}

}  // namespace
}  // namespace object_modelling::source
