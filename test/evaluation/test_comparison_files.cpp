#include "object_modelling/evaluation/comparison_files.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/mesh/mesh_files.h"
#include "support/shapes.h"
#include "support/temp_dir.h"
#include "support/transform_matchers.h"

namespace object_modelling::evaluation
{
namespace
{
class ComparisonFilesTest : public ::testing::Test
{
protected:
  std::string file(const std::string& name, const std::string& text) const
  {
    std::ofstream(folder_.path(name), std::ios::binary) << text;
    return folder_.path(name);
  }
  base::StatusCode codeOf(const std::string& path) const
  {
    try
    {
      readGeometry(path);
    }
    catch (const base::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      return error.code();
    }
    return base::StatusCode::OK;
  }
  test_support::TempDir folder_;
};

const char DOUBLE_TRIANGLE[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n100 0 0\n0 250 0\n3 0 1 2\n";

TEST_F(ComparisonFilesTest, ReadsMeshesAndClouds)
{
  const mesh::TriangleMesh mesh = test_support::lopsidedShape(3);
  for (const char* name : { "a b;$(touch x)'\".ply", "mesh.obj" })
  {
    mesh::writeMesh(folder_.path(name), mesh);
    EXPECT_EQ(readGeometry(folder_.path(name)).triangles.size(), mesh.triangles.size()) << name;
  }
  const mesh::TriangleMesh triangle = readGeometry(file("double.PLY", DOUBLE_TRIANGLE), 0.001);
  ASSERT_EQ(triangle.triangles.size(), 1u);
  EXPECT_FLOAT_EQ(triangle.vertices[2].y(), 0.25f);
  const mesh::TriangleMesh cloud =
      readGeometry(file("cloud.ply",
                        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                        "property float z\nend_header\n1 2 3\n4 5 6\n"));
  EXPECT_TRUE(cloud.empty());
  ASSERT_EQ(cloud.vertices.size(), 2u);
  EXPECT_EQ(cloud.vertices[1], Eigen::Vector3f(4, 5, 6));
  const std::string pcd = file("cloud.pcd",
                               "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\n"
                               "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n7 8 9\n");
  EXPECT_EQ(readGeometry(pcd).vertices.at(0), Eigen::Vector3f(7, 8, 9));
}

TEST_F(ComparisonFilesTest, NamesFilesThatCannotBeRead)
{
  EXPECT_EQ(codeOf(folder_.path("missing.ply")), base::StatusCode::NOT_FOUND);
  EXPECT_EQ(codeOf(folder_.path()), base::StatusCode::NOT_FOUND);
  EXPECT_EQ(codeOf(file("mesh.xyz", "1 2 3")), base::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(codeOf(file("rubbish.ply", "not a ply")), base::StatusCode::BAD_INPUT);
  EXPECT_EQ(codeOf(file("empty.pcd", "")), base::StatusCode::BAD_INPUT);
  EXPECT_EQ(codeOf(file("flat.ply",
                        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                        "end_header\n1 2\n")),
            base::StatusCode::BAD_INPUT);
  std::string wrong_index = DOUBLE_TRIANGLE;
  wrong_index.replace(wrong_index.rfind("2\n"), 1, "9");
  EXPECT_EQ(codeOf(file("index.ply", wrong_index)), base::StatusCode::BAD_INPUT);
}

TEST_F(ComparisonFilesTest, TransformsComeBackAndMustBeRigid)
{
  const std::string path = folder_.path("T.txt");
  writeTransform(path, test_support::farAway());
  EXPECT_TRANSFORM_NEAR(readTransform(path), test_support::farAway(), 1e-10, 1e-7);
  for (const char* text :
       { "", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1",
         "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "1 0 0 x 0 1 0 0 0 0 1 0 0 0 0 1", "1 0 0 nan 0 1 0 0 0 0 1 0 0 0 0 1" })
    EXPECT_THROW(readTransform(file("bad.txt", text)), base::Error) << text;
}

TEST_F(ComparisonFilesTest, HistogramCountsAndPicture)
{
  const std::vector<double> distances_m{ 0, 0.00004, 0.00012, 0.0007, 0.4 };
  const Histogram histogram = histogramOf(distances_m, 0.0001, 5);
  EXPECT_EQ(histogram.counts, (std::vector<std::size_t>{ 2, 1, 0, 0, 2 }));
  const std::string path = folder_.path("histogram.png");
  writeHistogram(path, histogram, statisticsOf(distances_m));
  const cv::Mat image = cv::imread(path);
  ASSERT_FALSE(image.empty());
  EXPECT_GT(cv::norm(image, cv::Mat(image.size(), image.type(), cv::Scalar::all(255))), 1000);
  EXPECT_THROW(writeHistogram(folder_.path("histogram.nothing"), histogram, statisticsOf(distances_m)), base::Error);
  EXPECT_THROW(writeHistogram(folder_.path("no/folder.png"), histogram, statisticsOf(distances_m)), base::Error);
}

TEST_F(ComparisonFilesTest, ColoredCloud)
{
  Comparison comparison;
  comparison.points_reference = { { 1, 2, 3 }, { 4, 5, 6 } };
  comparison.distances_m = { 0, 0.01 };
  const std::string path = folder_.path("cloud.ply");
  writeColoredCloud(path, comparison, 0.002);
  const mesh::TriangleMesh cloud = readGeometry(path);
  ASSERT_EQ(cloud.vertices.size(), 2u);
  EXPECT_EQ(cloud.vertices[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_THROW(writeColoredCloud(folder_.path("no/cloud.ply"), comparison, 0.002), base::Error);
}

}  // namespace
}  // namespace object_modelling::evaluation
