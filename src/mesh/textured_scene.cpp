#include "textured_scene.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <tuple>

#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
constexpr unsigned MAX_HINT = 3;

[[noreturn]] void refuse(const std::string& reason)
{
  throw base::Error(base::StatusCode::BAD_INPUT, reason);
}

/// Vertices split by their texture coordinates.
struct SplitVertices
{
  std::vector<std::pair<std::uint32_t, Eigen::Vector2f>> vertices;
  std::vector<std::array<unsigned, 3>> triangles;
};

SplitVertices split(const TexturedMesh& textured)
{
  SplitVertices result;
  std::map<std::tuple<std::uint32_t, float, float>, unsigned> known;
  for (std::size_t t = 0; t < textured.mesh.triangles.size(); ++t)
  {
    std::array<unsigned, 3> triangle{};
    for (int k = 0; k < 3; ++k)
    {
      const std::uint32_t vertex = textured.mesh.triangles[t][k];
      const Eigen::Vector2f& uv = textured.uvs[t][k];
      const auto [at, added] =
          known.emplace(std::make_tuple(vertex, uv.x(), uv.y()), static_cast<unsigned>(result.vertices.size()));
      if (added)
        result.vertices.emplace_back(vertex, uv);
      triangle[k] = at->second;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

void fillMesh(const TexturedMesh& textured, aiMesh* mesh)
{
  const SplitVertices vertices = split(textured);
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = static_cast<unsigned>(vertices.vertices.size());
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  mesh->mTextureCoords[0] = new aiVector3D[mesh->mNumVertices];
  mesh->mNumUVComponents[0] = 2;
  if (!textured.mesh.normals.empty())
    mesh->mNormals = new aiVector3D[mesh->mNumVertices];
  for (unsigned i = 0; i < mesh->mNumVertices; ++i)
  {
    const auto& [vertex, uv] = vertices.vertices[i];
    const Eigen::Vector3f& p = textured.mesh.vertices[vertex];
    mesh->mVertices[i] = aiVector3D(p.x(), p.y(), p.z());
    mesh->mTextureCoords[0][i] = aiVector3D(uv.x(), uv.y(), 0);
    if (mesh->mNormals != nullptr)
    {
      const Eigen::Vector3f& n = textured.mesh.normals[vertex];
      mesh->mNormals[i] = aiVector3D(n.x(), n.y(), n.z());
    }
  }
  mesh->mNumFaces = static_cast<unsigned>(vertices.triangles.size());
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (unsigned i = 0; i < mesh->mNumFaces; ++i)
  {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3];
    std::copy(vertices.triangles[i].begin(), vertices.triangles[i].end(), mesh->mFaces[i].mIndices);
  }
}

void fillMaterial(const std::string& texture_file, aiMaterial* material)
{
  const aiString name("textured"), file(texture_file);
  material->AddProperty(&name, AI_MATKEY_NAME);
  material->AddProperty(&file, AI_MATKEY_TEXTURE_DIFFUSE(0));
  const aiColor3D white(1, 1, 1);
  material->AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
  material->AddProperty(&white, 1, AI_MATKEY_COLOR_AMBIENT);
  // The names of glTF's factors changed between assimp 5.0 and 5.2; unset, viewers show polished metal.
  const float none = 0, full = 1;
  for (const char* key : { "$mat.gltf.pbrMetallicRoughness.metallicFactor", "$mat.metallicFactor" })
    material->AddProperty(&none, 1, key, 0, 0);
  for (const char* key : { "$mat.gltf.pbrMetallicRoughness.roughnessFactor", "$mat.roughnessFactor" })
    material->AddProperty(&full, 1, key, 0, 0);
}

cv::Mat decode(const aiTexture& texture)
{
  if (texture.mHeight != 0)  // raw pixels, blue first
    return cv::Mat(static_cast<int>(texture.mHeight), static_cast<int>(texture.mWidth), CV_8UC4, texture.pcData)
        .clone();
  const std::vector<unsigned char> bytes(reinterpret_cast<const unsigned char*>(texture.pcData),
                                         reinterpret_cast<const unsigned char*>(texture.pcData) + texture.mWidth);
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

cv::Mat loadTexture(const aiScene& scene, const aiMesh& mesh, const std::string& folder)
{
  aiString name;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != AI_SUCCESS)
    refuse("its material names no texture");
  cv::Mat image;
  if (const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str()))
    image = decode(*embedded);
  else
    image = cv::imread(folder + "/" + name.C_Str(), cv::IMREAD_COLOR);
  if (image.empty() || image.type() != CV_8UC3)
    refuse("its texture '" + std::string(name.C_Str()) + "' cannot be read");
  return image;
}
}  // namespace

std::unique_ptr<aiScene> makeTexturedScene(const TexturedMesh& textured, const std::string& texture_file,
                                           const std::vector<unsigned char>& embedded_png)
{
  // The scene owns its arrays and frees them with delete[], hence the bare new.
  auto scene = std::make_unique<aiScene>();
  scene->mRootNode = new aiNode("textured");
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial* [1] { new aiMaterial() };
  fillMaterial(texture_file, scene->mMaterials[0]);
  scene->mNumMeshes = 1;
  scene->mMeshes = new aiMesh* [1] { new aiMesh() };
  scene->mRootNode->mNumMeshes = 1;
  scene->mRootNode->mMeshes = new unsigned[1]{ 0 };
  fillMesh(textured, scene->mMeshes[0]);
  if (!embedded_png.empty())
  {
    auto* texture = new aiTexture();
    texture->mWidth = static_cast<unsigned>(embedded_png.size());
    texture->mHeight = 0;
    std::strncpy(texture->achFormatHint, "png", MAX_HINT + 1);
    texture->pcData = new aiTexel[(embedded_png.size() + sizeof(aiTexel) - 1) / sizeof(aiTexel)];
    std::memcpy(texture->pcData, embedded_png.data(), embedded_png.size());
    scene->mNumTextures = 1;
    scene->mTextures = new aiTexture* [1] { texture };
  }
  return scene;
}

TexturedMesh fromTexturedScene(const aiScene& scene, const std::string& folder)
{
  TexturedMesh textured;
  std::map<std::array<float, 3>, std::uint32_t> known;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
  {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (!mesh.HasTextureCoords(0))
      refuse("it has no texture coordinates");
    if (m == 0)
      textured.texture_bgr = loadTexture(scene, mesh, folder);
    std::vector<std::uint32_t> index(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i)
    {
      const aiVector3D& p = mesh.mVertices[i];
      const auto [at, added] = known.emplace(std::array<float, 3>{ p.x, p.y, p.z },
                                             static_cast<std::uint32_t>(textured.mesh.vertices.size()));
      index[i] = at->second;
      if (added)
        textured.mesh.vertices.emplace_back(p.x, p.y, p.z);
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i)
    {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3)
        continue;
      std::array<std::uint32_t, 3> triangle{};
      std::array<Eigen::Vector2f, 3> uvs;
      for (int k = 0; k < 3; ++k)
      {
        triangle[k] = index[face.mIndices[k]];
        const aiVector3D& uv = mesh.mTextureCoords[0][face.mIndices[k]];
        uvs[k] = { uv.x, uv.y };
      }
      textured.mesh.triangles.push_back(triangle);
      textured.uvs.push_back(uvs);
    }
  }
  if (textured.mesh.empty())
    refuse("it has no triangles");
  computeNormals(&textured.mesh);
  return textured;
}

}  // namespace object_modelling::mesh
