#include "object_modelling/mesh/foreign_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "object_modelling/base/file_extension.h"
#include "object_modelling/base/status.h"
#include "object_modelling/mesh/mesh_files.h"
#include "object_modelling/mesh/textured_mesh_files.h"

namespace object_modelling::mesh
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

/// Parts after one another, no vertices joined.
TriangleMesh readByAssimp(const std::string& path)
{
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_ValidateDataStructure);
  if (scene == nullptr)
    throw Error(StatusCode::BAD_INPUT, "'" + path + "' cannot be read: " + importer.GetErrorString());
  TriangleMesh mesh;
  bool colors = true;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
    colors = colors && scene->mMeshes[m]->HasVertexColors(0);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
  {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i)
    {
      mesh.vertices.emplace_back(part.mVertices[i].x, part.mVertices[i].y, part.mVertices[i].z);
      if (!colors)
        continue;
      const aiColor4D& color = part.mColors[0][i];
      const Eigen::Vector3f rgb = 255 * Eigen::Vector3f(color.r, color.g, color.b);
      mesh.colors.emplace_back(rgb.cwiseMax(0).cwiseMin(255).array().round().matrix().cast<std::uint8_t>());
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i)
      if (part.mFaces[i].mNumIndices == 3)
        mesh.triangles.push_back({ first + part.mFaces[i].mIndices[0], first + part.mFaces[i].mIndices[1],
                                   first + part.mFaces[i].mIndices[2] });
  }
  return mesh;
}

/// What can be used of it; `uvs` go along where there are some.
TexturedMesh cleaned(const TexturedMesh& source)
{
  TexturedMesh result;
  result.texture_bgr = source.texture_bgr;
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> index;
  for (std::size_t i = 0; i < source.mesh.vertices.size(); ++i)
  {
    const Eigen::Vector3f& p = source.mesh.vertices[i];
    if (!p.allFinite())
      throw Error(StatusCode::BAD_INPUT, "a vertex is not finite");
    const auto next = static_cast<std::uint32_t>(result.mesh.vertices.size());
    const auto [place, added] = known.insert({ { p.x(), p.y(), p.z() }, next });
    index.push_back(place->second);
    if (!added)
      continue;
    result.mesh.vertices.push_back(p);
    if (!source.mesh.colors.empty())
      result.mesh.colors.push_back(source.mesh.colors[i]);
  }
  for (std::size_t t = 0; t < source.mesh.triangles.size(); ++t)
  {
    const auto& [a, b, c] = source.mesh.triangles[t];
    const Eigen::Vector3f &p = source.mesh.vertices[a], &q = source.mesh.vertices[b], &r = source.mesh.vertices[c];
    if (!((q - p).cross(r - p).norm() > 0))
      continue;
    result.mesh.triangles.push_back({ index[a], index[b], index[c] });
    if (!source.uvs.empty())
      result.uvs.push_back(source.uvs[t]);
  }
  if (result.mesh.empty())
    throw Error(StatusCode::BAD_INPUT, "it has no triangles with an area");
  computeNormals(&result.mesh);
  return result;
}

/// As the texture has it; a vertex with several places on it takes the last.
void colorByTexture(TexturedMesh* textured)
{
  textured->mesh.colors.assign(textured->mesh.vertices.size(), { 128, 128, 128 });
  for (std::size_t t = 0; t < textured->uvs.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
    {
      Eigen::Vector2f& uv = textured->uvs[t][k];
      uv = uv.cwiseMax(0).cwiseMin(1);
      const Eigen::Vector2f texel = textured->texel(uv);
      const int u = std::clamp(static_cast<int>(std::lround(texel.x())), 0, textured->texture_bgr.cols - 1);
      const int v = std::clamp(static_cast<int>(std::lround(texel.y())), 0, textured->texture_bgr.rows - 1);
      const cv::Vec3b& bgr = textured->texture_bgr.at<cv::Vec3b>(v, u);
      textured->mesh.colors[textured->mesh.triangles[t][k]] = { bgr[2], bgr[1], bgr[0] };
    }
}

double longestEdge(const TriangleMesh& mesh)
{
  float longest = 0;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      longest = std::max(longest, (mesh.vertices[triangle[i]] - mesh.vertices[triangle[(i + 1) % 3]]).norm());
  return static_cast<double>(longest);
}

TexturedMesh cutIntoFour(const TexturedMesh& source)
{
  TexturedMesh result = source;
  result.mesh.triangles.clear();
  result.uvs.clear();
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b)
  {
    const auto [place, added] =
        middles.insert({ std::minmax(a, b), static_cast<std::uint32_t>(result.mesh.vertices.size()) });
    if (added)
    {
      result.mesh.vertices.emplace_back((source.mesh.vertices[a] + source.mesh.vertices[b]) / 2);
      if (!source.mesh.colors.empty())
        result.mesh.colors.emplace_back(
            ((source.mesh.colors[a].cast<int>() + source.mesh.colors[b].cast<int>()) / 2).cast<std::uint8_t>());
    }
    return place->second;
  };
  for (std::size_t t = 0; t < source.mesh.triangles.size(); ++t)
  {
    const auto& [a, b, c] = source.mesh.triangles[t];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<std::uint32_t, 3>& part :
         { std::array<std::uint32_t, 3>{ a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } })
      result.mesh.triangles.push_back(part);
    if (source.uvs.empty())
      continue;
    const auto& uv = source.uvs[t];
    const Eigen::Vector2f uv_ab = (uv[0] + uv[1]) / 2, uv_bc = (uv[1] + uv[2]) / 2, uv_ca = (uv[2] + uv[0]) / 2;
    result.uvs.push_back({ uv[0], uv_ab, uv_ca });
    result.uvs.push_back({ uv_ab, uv[1], uv_bc });
    result.uvs.push_back({ uv_ca, uv_bc, uv[2] });
    result.uvs.push_back({ uv_ab, uv_bc, uv_ca });
  }
  return result;
}
}  // namespace

TexturedMesh readForeignMesh(const std::string& path)
{
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    throw Error(StatusCode::NOT_FOUND, "mesh file '" + path + "' does not exist");
  const std::string extension = base::lowerExtension(path);
  try
  {
    if (extension == ".obj" || extension == ".glb")
    {
      try
      {
        TexturedMesh textured = cleaned(readTexturedMesh(path));
        colorByTexture(&textured);
        return textured;
      }
      catch (const Error&)  // no texture: without, then
      {
      }
    }
    TexturedMesh plain;
    // Assimp 5.2 waits for ever for the rest of a PLY file that was cut off.
    plain.mesh = extension == ".ply" ? readMesh(path) : readByAssimp(path);
    return cleaned(plain);
  }
  catch (const Error& error)
  {
    throw Error(error.code(), "mesh file '" + path + "' cannot be used: " + error.what());
  }
  catch (const std::exception& error)  // the libraries' own, on files that promise more than they hold
  {
    throw Error(StatusCode::BAD_INPUT, "mesh file '" + path + "' cannot be read: " + error.what());
  }
}

TexturedMesh subdivided(TexturedMesh textured, double max_edge_m, std::size_t max_triangles)
{
  const bool was_fine = longestEdge(textured.mesh) <= max_edge_m;
  while (longestEdge(textured.mesh) > max_edge_m && 4 * textured.mesh.triangles.size() <= max_triangles)
    textured = cutIntoFour(textured);
  if (!was_fine)
  {
    computeNormals(&textured.mesh);
    if (!textured.texture_bgr.empty())
      colorByTexture(&textured);
  }
  return textured;
}

}  // namespace object_modelling::mesh
