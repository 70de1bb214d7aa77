#include <algorithm>
#include <fstream>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>

#include "mesh_file_formats.h"
#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
/// The scene owns its arrays and frees them with delete[], hence the bare new.
void fill(const TriangleMesh& source, aiMesh* mesh)
{
  mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  mesh->mNumVertices = static_cast<unsigned>(source.vertices.size());
  mesh->mVertices = new aiVector3D[mesh->mNumVertices];
  for (unsigned i = 0; i < mesh->mNumVertices; ++i)
    mesh->mVertices[i] = aiVector3D(source.vertices[i].x(), source.vertices[i].y(), source.vertices[i].z());
  if (!source.normals.empty())
  {
    mesh->mNormals = new aiVector3D[mesh->mNumVertices];
    for (unsigned i = 0; i < mesh->mNumVertices; ++i)
      mesh->mNormals[i] = aiVector3D(source.normals[i].x(), source.normals[i].y(), source.normals[i].z());
  }
  if (!source.colors.empty())
  {
    mesh->mColors[0] = new aiColor4D[mesh->mNumVertices];
    for (unsigned i = 0; i < mesh->mNumVertices; ++i)
    {
      const auto& color = source.colors[i];
      mesh->mColors[0][i] = aiColor4D(color[0] / 255.f, color[1] / 255.f, color[2] / 255.f, 1.f);
    }
  }
  mesh->mNumFaces = static_cast<unsigned>(source.triangles.size());
  mesh->mFaces = new aiFace[mesh->mNumFaces];
  for (unsigned i = 0; i < mesh->mNumFaces; ++i)
  {
    mesh->mFaces[i].mNumIndices = 3;
    mesh->mFaces[i].mIndices = new unsigned[3];
    std::copy(source.triangles[i].begin(), source.triangles[i].end(), mesh->mFaces[i].mIndices);
  }
}

std::uint8_t byteFrom(float value)
{
  return static_cast<std::uint8_t>(std::min(255.f, std::max(0.f, value * 255.f + 0.5f)));
}

void append(const aiMesh& source, bool normals, bool colors, TriangleMesh* mesh)
{
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  for (unsigned i = 0; i < source.mNumVertices; ++i)
  {
    const aiVector3D& p = source.mVertices[i];
    mesh->vertices.push_back({ p.x, p.y, p.z });
    if (normals)
      mesh->normals.push_back({ source.mNormals[i].x, source.mNormals[i].y, source.mNormals[i].z });
    if (colors)
    {
      const aiColor4D& color = source.mColors[0][i];
      mesh->colors.push_back({ byteFrom(color.r), byteFrom(color.g), byteFrom(color.b) });
    }
  }
  for (unsigned i = 0; i < source.mNumFaces; ++i)
  {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices == 3)
      mesh->triangles.push_back({ first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2] });
  }
}

}  // namespace

void writeObj(const std::string& path, const TriangleMesh& mesh)
{
  aiScene scene;
  scene.mRootNode = new aiNode("mesh");
  scene.mNumMaterials = 1;
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial() };
  scene.mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { new aiMesh() };
  scene.mRootNode->mNumMeshes = 1;
  scene.mRootNode->mMeshes = new unsigned[1]{ 0 };
  fill(mesh, scene.mMeshes[0]);

  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, "objnomtl");
  if (blob == nullptr)
    throw base::Error(base::StatusCode::INTERNAL, "no OBJ for '" + path + "': " + exporter.GetErrorString());
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(blob->data), static_cast<std::streamsize>(blob->size));
  file.close();
  if (!file)
    throw base::Error(base::StatusCode::STORAGE, "writing '" + path + "' failed: is the disk full?");
}

TriangleMesh readObj(const std::string& path)
{
  Assimp::Importer importer;
  // Texture coordinates would keep vertices apart that are one.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_TEXCOORDS | aiComponent_MATERIALS);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_RemoveComponent |
                                                     aiProcess_JoinIdenticalVertices | aiProcess_ValidateDataStructure);
  if (scene == nullptr)
    throw base::Error(base::StatusCode::BAD_INPUT,
                      "'" + path + "' is not an OBJ file that can be read: " + importer.GetErrorString());
  bool normals = true, colors = true;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
  {
    normals = normals && scene->mMeshes[i]->HasNormals();
    colors = colors && scene->mMeshes[i]->HasVertexColors(0);
  }
  TriangleMesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i)
    append(*scene->mMeshes[i], normals, colors, &mesh);
  return mesh;
}

}  // namespace object_modelling::mesh
