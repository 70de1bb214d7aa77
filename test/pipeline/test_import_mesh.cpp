#include "object_modelling/pipeline/import_mesh.h"

#include <gtest/gtest.h>

#include <sstream>

#include <opencv2/core.hpp>

#include "object_modelling/database/cloud_file.h"
#include "object_modelling/mesh/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"

namespace object_modelling::pipeline
{
namespace
{
using base::StatusCode;
using test_support::statusOf;

/// A box on its edge, away from the origin.
std::string boxFile(const test_support::TempDir& folder, float scale)
{
  mesh::TriangleMesh mesh;
  test_support::addBox({ 0, 0, 0 }, { 0.2f, 0.1f, 0.06f }, 2, &mesh);
  mesh::transform(test_support::farAway(), &mesh);
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex *= scale;
  const std::string path = folder.path("part.ply");
  mesh::writeMesh(path, mesh);
  return path;
}
}  // namespace

TEST(ImportMesh, ABoxInMillimetersBecomesAnObject)
{
  const test_support::TempDir folder;
  database::ObjectDatabase database(folder.path("db"), true);
  base::JobControl control;
  const ImportReport report = importMesh(boxFile(folder, 1000), "part", "A part", database, {}, control);
  EXPECT_EQ(report.unit_m, 0.001);
  EXPECT_LT((report.size_m - Eigen::Vector3d(0.2, 0.1, 0.06)).norm(), 1e-4) << report.size_m.transpose();
  EXPECT_EQ(database.check(), std::vector<std::string>());
  const database::ObjectEntry entry = database.entry("part");
  EXPECT_EQ(entry.name, "A part");
  EXPECT_TRUE(entry.sessions.empty());
  EXPECT_NEAR(entry.diameter_m, 0.2332, 3e-3);
  ASSERT_TRUE(entry.properties);
  EXPECT_EQ(entry.properties->symmetries.size(), 6u) << report.properties;  // of shape, and of its one colour
  ASSERT_EQ(entry.properties->resting_poses.size(), 6u);
  EXPECT_FALSE(entry.properties->resting_poses[0].seen);
  EXPECT_NEAR(entry.properties->resting_poses[0].T_support_model.linear()(2, 2), 1, 1e-6);
  EXPECT_NEAR(entry.T_support_model.at(0).translation().z(), 0.03, 1e-5);
  EXPECT_FALSE(entry.properties->unseen->bottom);
  const fusion::FusedCloud cloud = database::readCloud(report.object_folder + "/cloud.pcd");
  EXPECT_NEAR(static_cast<double>(cloud.size()), 76000, 1000);
  for (std::size_t i = 0; i < cloud.size(); i += 100)
    EXPECT_GT(cloud.normals[i].dot(cloud.points[i]), 0.02f);
}

TEST(ImportMesh, AStoolOnThinLegsHasNoUnseenBottom)
{
  const test_support::TempDir folder;
  database::ObjectDatabase database(folder.path("db"), true);
  mesh::TriangleMesh stool;
  test_support::addBox({ 0, 0, 0.05F }, { 0.1F, 0.1F, 0.02F }, 4, &stool);
  for (const float x : { 0.F, 0.096F })
    for (const float y : { 0.F, 0.096F })
      test_support::addBox({ x, y, 0 }, { 0.004F, 0.004F, 0.05F }, 1, &stool);
  mesh::writeMesh(folder.path("stool.ply"), stool);
  base::JobControl control;
  ImportOptions options;
  options.unit_m = 1;
  importMesh(folder.path("stool.ply"), "stool", "", database, options, control);
  ASSERT_TRUE(database.entry("stool").properties->unseen);
  EXPECT_EQ(database.entry("stool").properties->unseen->ratio, 0);
  EXPECT_FALSE(database.entry("stool").properties->unseen->bottom);
}

TEST(ImportMesh, ViewsShowTheObject)
{
  const test_support::TempDir folder;
  base::JobControl control;
  const database::ObjectModel model = modelFromMesh(boxFile(folder, 1), "part", "", {}, control);
  ASSERT_EQ(model.views.size(), 42u);
  for (const rgbd::View& view : model.views)
  {
    const rgbd::Frame& frame = view.frame;
    EXPECT_GT(cv::countNonZero(frame.object_mask), 5000);
    EXPECT_EQ(frame.object_mask.at<unsigned char>(0, 0), 0) << "the whole object is in the image";
    for (int v = 0; v < frame.depth_m.rows; v += 20)
      for (int u = 0; u < frame.depth_m.cols; u += 20)
        if (frame.object_mask.at<unsigned char>(v, u) > 0)
        {
          const Eigen::Vector3d p = view.T_world_camera * frame.point(u, v).cast<double>();
          EXPECT_LT((p.cwiseAbs() - Eigen::Vector3d(0.1, 0.05, 0.03)).maxCoeff(), 1e-4);
        }
  }
  EXPECT_EQ(model.name, "part");
  EXPECT_EQ(model.provenance.at("imported_mesh"), "part.ply");
  std::istringstream numbers(model.provenance.at("model_from_imported_mesh").substr(1));
  Eigen::Matrix4d T_model_mesh;
  char comma;
  for (int i = 0; i < 16; ++i)
    numbers >> T_model_mesh(i / 4, i % 4) >> comma;
  mesh::TriangleMesh file = mesh::readMesh(folder.path("part.ply"));
  mesh::transform(Eigen::Isometry3d(T_model_mesh), &file);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : file.vertices)
    box.extend(vertex);
  EXPECT_LT((box.max() - Eigen::Vector3f(0.1F, 0.05F, 0.03F)).cwiseAbs().maxCoeff(), 1e-4F) << box.max().transpose();
  EXPECT_LT((box.min() + Eigen::Vector3f(0.1F, 0.05F, 0.03F)).cwiseAbs().maxCoeff(), 1e-4F) << box.min().transpose();
}

TEST(ImportMesh, TheUnitIsFoundWhereItIsClear)
{
  EXPECT_EQ(unitBySize_m(0.2), 1);
  EXPECT_EQ(unitBySize_m(200), 0.001);
  for (const double unclear : { 0.001, 5.0, 5000.0 })
  {
    const base::Status status = statusOf([&] { unitBySize_m(unclear); });
    EXPECT_EQ(status.code, StatusCode::INVALID_ARGUMENT);
    EXPECT_TRUE(test_support::mentions(status, "--unit"));
  }
}

TEST(ImportMesh, AnObjectIsReplacedOnlyOnRequest)
{
  const test_support::TempDir folder;
  database::ObjectDatabase database(folder.path("db"), true);
  base::JobControl control;
  const std::string path = boxFile(folder, 1);
  importMesh(path, "part", "", database, {}, control);
  const auto again = [&](const std::string& id, const ImportOptions& options)
  { return statusOf([&] { importMesh(path, id, "", database, options, control); }).code; };
  EXPECT_EQ(again("part", {}), StatusCode::INVALID_ARGUMENT);
  ImportOptions replace;
  replace.replace = true;
  EXPECT_EQ(again("part", replace), StatusCode::OK);
  EXPECT_EQ(again("../part", replace), StatusCode::INVALID_ARGUMENT);
  replace.unit_m = -1;
  EXPECT_EQ(again("part", replace), StatusCode::INVALID_ARGUMENT);
}

}  // namespace object_modelling::pipeline
