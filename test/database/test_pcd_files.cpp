#include <gtest/gtest.h>

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>
#include <filesystem>
#include <sstream>

#include "model_fixtures.h"
#include "object_modelling/base/atomic_file.h"
#include "object_modelling/database/cloud_file.h"
#include "object_modelling/database/object_database.h"
#include "support/temp_dir.h"

namespace object_modelling::database
{
namespace fs = std::filesystem;
using base::StatusCode;

TEST(CloudFile, GivesBackEveryValue)
{
  const test_support::TempDir folder;
  const fusion::FusedCloud cloud = makeModel("x", 3, 0).cloud;
  writeCloud(folder.path("cloud.pcd"), cloud);
  const fusion::FusedCloud read = readCloud(folder.path("cloud.pcd"));
  EXPECT_EQ(read.points, cloud.points);
  EXPECT_EQ(read.normals, cloud.normals);
  EXPECT_EQ(read.colors, cloud.colors);
  EXPECT_EQ(read.weights, cloud.weights);
  EXPECT_EQ(read.sigmas_m, cloud.sigmas_m);
}

TEST(CloudFile, RefusesWhatIsNoCloud)
{
  const test_support::TempDir folder;
  const std::string path = folder.path("cloud.pcd");
  EXPECT_EQ(statusOf([&] { readCloud(path); }).code, StatusCode::NOT_FOUND);
  base::writeTextFile(path, "no point cloud");
  EXPECT_EQ(statusOf([&] { readCloud(path); }).code, StatusCode::BAD_INPUT);
  fusion::FusedCloud cloud = makeModel("x", 0, 0).cloud;
  writeCloud(path, cloud);
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_EQ(statusOf([&] { readCloud(path); }).code, StatusCode::BAD_INPUT);
  base::writeTextFile(path,
                      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
                      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  const base::Status status = statusOf([&] { readCloud(path); });
  EXPECT_EQ(status.code, StatusCode::BAD_INPUT);
  EXPECT_TRUE(mentions(status, "normal_x")) << status.message;
  cloud.normals.pop_back();
  EXPECT_EQ(statusOf([&] { writeCloud(path, cloud); }).code, StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(statusOf([&] { writeCloud(path, {}); }).code, StatusCode::INVALID_ARGUMENT);
  const fusion::FusedCloud whole = makeModel("x", 0, 0).cloud;
  EXPECT_EQ(statusOf([&] { writeCloud(folder.path("no/cloud.pcd"), whole); }).code, StatusCode::STORAGE);
}

/// What a reader of V4R's layout relies on: the pose file takes points of the organised cloud into the model frame.
TEST(ViewFiles, PoseTakesTheObjectIndicesOntoTheObject)
{
  const test_support::TempDir folder;
  const ObjectModel model = makeModel("cereal", 0, 1);
  base::JobControl control;
  const std::string views = ObjectDatabase(folder.path("db"), true).write(model, control) + "/views/";
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(pcl::PCDReader().read(views + "cloud_00000000.pcd", cloud), 0);
  EXPECT_EQ(cloud.width, 640u);
  EXPECT_EQ(cloud.height, 480u);
  ASSERT_EQ(cloud.fields.size(), 4u);
  EXPECT_EQ(cloud.fields[3].name, "rgb");

  Eigen::Matrix4d T_model_camera;
  std::istringstream pose(base::readTextFile(views + "pose_00000000.txt"));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      ASSERT_TRUE(pose >> T_model_camera(row, column));
  EXPECT_EQ(T_model_camera, model.views[0].T_world_camera.matrix());

  std::istringstream indices(base::readTextFile(views + "object_indices_00000000.txt"));
  int count = 0;
  for (int index = 0; indices >> index; ++count)
  {
    Eigen::Vector3f p_camera;
    std::memcpy(p_camera.data(), cloud.data.data() + static_cast<std::size_t>(index) * cloud.point_step, 12);
    const Eigen::Vector3d p_model =
        (T_model_camera * p_camera.cast<double>().homogeneous()).head<3>() - Eigen::Vector3d(0, 0, 0.1);
    ASSERT_TRUE((p_model.cwiseAbs() - Eigen::Vector3d(0.0401, 0.0601, 0.1001)).maxCoeff() < 0) << p_model.transpose();
  }
  EXPECT_GT(count, 5000);
}

}  // namespace object_modelling::database
