#include "object_modelling/mesh/textured_mesh_files.h"

#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include "object_modelling/mesh/textured_renderer.h"
#include "support/temp_dir.h"
#include "support/thrown_status.h"
#include "texture_scene.h"

namespace object_modelling::texture
{
namespace
{
/// A box whose faces share one picture of four colours.
mesh::TexturedMesh printedBox()
{
  mesh::TexturedMesh textured;
  textured.mesh = boxMesh(0.04, true);
  textured.texture_bgr = cv::Mat(64, 96, CV_8UC3);
  for (int v = 0; v < 64; ++v)
    for (int u = 0; u < 96; ++u)
      textured.texture_bgr.at<cv::Vec3b>(v, u) = cv::Vec3b(u < 48 ? 30 : 220, v < 32 ? 40 : 200, u + v);
  for (std::size_t t = 0; t < textured.mesh.triangles.size(); ++t)
  {
    std::array<Eigen::Vector2f, 3> uvs;
    for (int k = 0; k < 3; ++k)
    {
      const Eigen::Vector3f& p = textured.mesh.vertices[textured.mesh.triangles[t][k]];
      uvs[k] = { 0.5f + 4 * p.x() + 0.5f * p.y(), 0.1f + 5 * p.z() };
    }
    textured.uvs.push_back(uvs);
  }
  return textured;
}

base::StatusCode codeOf(const std::function<void()>& action)
{
  return test_support::statusOf(action).code;
}

cv::Mat picture(const mesh::TexturedMesh& textured)
{
  return mesh::renderFourSides(textured, 160);
}

class TexturedMeshFiles : public ::testing::TestWithParam<std::string>
{
protected:
  test_support::TempDir folder_;
};

TEST_P(TexturedMeshFiles, ComeBackEqual)
{
  const mesh::TexturedMesh textured = printedBox();
  const std::string path = folder_.path("model." + GetParam());
  mesh::writeTexturedMesh(path, textured);
  const mesh::TexturedMesh back = mesh::readTexturedMesh(path);
  EXPECT_EQ(cv::norm(back.texture_bgr, textured.texture_bgr, cv::NORM_INF), 0);
  EXPECT_EQ(back.mesh.vertices.size(), textured.mesh.vertices.size());
  ASSERT_EQ(back.mesh.triangles.size(), textured.mesh.triangles.size());
  for (std::size_t t = 0; t < textured.uvs.size(); ++t)
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_LT((back.uvs[t][k] - textured.uvs[t][k]).norm(), 1e-5);
      EXPECT_LT((back.mesh.vertices[back.mesh.triangles[t][k]] - textured.mesh.vertices[textured.mesh.triangles[t][k]])
                    .norm(),
                1e-6);
    }
  EXPECT_LT(cv::norm(picture(back), picture(textured), cv::NORM_L1) / picture(back).total(), 0.1);
}

TEST_P(TexturedMeshFiles, AreTheSameBytesWhereverTheyAreWritten)
{
  const mesh::TexturedMesh textured = printedBox();
  std::filesystem::create_directory(folder_.path("a"));
  std::filesystem::create_directory(folder_.path("b"));
  std::vector<std::string> names;
  for (const std::string folder : { "a", "b" })
    mesh::writeTexturedMesh(folder_.path(folder + "/model." + GetParam()), textured);
  const auto content = [](const std::filesystem::path& path)
  {
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path("a")))
  {
    EXPECT_EQ(content(entry.path()), content(folder_.path("b/" + entry.path().filename().string())));
    ++files;
  }
  EXPECT_EQ(files, GetParam() == "obj" ? 3u : 1u);  // and no temporaries
}

TEST_P(TexturedMeshFiles, NameWhatIsWrong)
{
  EXPECT_EQ(codeOf([&] { mesh::readTexturedMesh(folder_.path("none." + GetParam())); }), base::StatusCode::NOT_FOUND);
  EXPECT_EQ(codeOf([&] { mesh::writeTexturedMesh(folder_.path("no_folder/a." + GetParam()), printedBox()); }),
            base::StatusCode::STORAGE);
  EXPECT_EQ(codeOf([&] { mesh::writeTexturedMesh(folder_.path("a." + GetParam()), {}); }),
            base::StatusCode::INVALID_ARGUMENT);
  mesh::TexturedMesh odd = printedBox();
  odd.uvs.pop_back();
  EXPECT_EQ(codeOf([&] { mesh::writeTexturedMesh(folder_.path("a." + GetParam()), odd); }),
            base::StatusCode::INVALID_ARGUMENT);
  const std::string damaged = folder_.path("damaged." + GetParam());
  std::ofstream(damaged) << "glTF or not";
  EXPECT_EQ(codeOf([&] { mesh::readTexturedMesh(damaged); }), base::StatusCode::BAD_INPUT);
}

INSTANTIATE_TEST_SUITE_P(Formats, TexturedMeshFiles, ::testing::Values("obj", "glb"));

TEST(TexturedMeshFile, WithoutItsImageIsRefused)
{
  const test_support::TempDir folder;
  mesh::writeTexturedMesh(folder.path("model.obj"), printedBox());
  std::filesystem::remove(folder.path("model.png"));
  EXPECT_EQ(codeOf([&] { mesh::readTexturedMesh(folder.path("model.obj")); }), base::StatusCode::BAD_INPUT);
  EXPECT_EQ(codeOf([&] { mesh::writeTexturedMesh(folder.path("model.stl"), printedBox()); }),
            base::StatusCode::INVALID_ARGUMENT);
}

}  // namespace
}  // namespace object_modelling::texture
