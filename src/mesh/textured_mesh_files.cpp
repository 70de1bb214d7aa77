#include "object_modelling/mesh/textured_mesh_files.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <assimp/postprocess.h>
#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/file_extension.h"
#include "object_modelling/base/status.h"
#include "textured_scene.h"

namespace object_modelling::mesh
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

std::string extensionOf(const std::string& path)
{
  const std::string extension = base::lowerExtension(path);
  if (extension != ".obj" && extension != ".glb")
    throw Error(StatusCode::INVALID_ARGUMENT,
                "textured mesh '" + path + "': extension '" + extension + "' is not known; use .obj or .glb");
  return extension;
}

void checkConsistent(const std::string& path, const TexturedMesh& textured)
{
  std::string defect;
  if (textured.empty())
    defect = "it has no triangles or no texture";
  else if (textured.uvs.size() != textured.mesh.triangles.size())
    defect = "it has not as many texture coordinates as triangles";
  else if (textured.texture_bgr.type() != CV_8UC3)
    defect = "its texture is not CV_8UC3";
  else if (!textured.mesh.normals.empty() && textured.mesh.normals.size() != textured.mesh.vertices.size())
    defect = "it has not as many normals as vertices";
  for (const auto& triangle : textured.mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (defect.empty() && vertex >= textured.mesh.vertices.size())
        defect = "a triangle has vertex " + std::to_string(vertex) + ", which does not exist";
  if (!defect.empty())
    throw Error(StatusCode::INVALID_ARGUMENT, "no textured mesh for '" + path + "': " + defect);
}

std::vector<unsigned char> encodePng(const cv::Mat& image)
{
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes))
    throw Error(StatusCode::INTERNAL, "the encoder for PNG failed");
  return bytes;
}

const aiExportDataBlob* exportScene(const std::string& path, const aiScene& scene, const char* format,
                                    Assimp::Exporter* exporter)
{
  const aiExportDataBlob* blob = exporter->ExportToBlob(&scene, format);
  if (blob == nullptr)
    throw Error(StatusCode::INTERNAL, "no textured mesh for '" + path + "': " + exporter->GetErrorString());
  return blob;
}

std::string textOf(const aiExportDataBlob& blob)
{
  return { static_cast<const char*>(blob.data), blob.size };
}

void writeGlb(const std::string& path, const TexturedMesh& textured)
{
  std::vector<unsigned char> png = encodePng(textured.texture_bgr);
  png.resize((png.size() + 3) / 4 * 4);  // to whole words: Assimp 5.0 fills the gap with whatever memory holds
  const std::unique_ptr<aiScene> scene = makeTexturedScene(textured, "*0", png);
  Assimp::Exporter exporter;
  base::writeTextFile(path, textOf(*exportScene(path, *scene, "glb2", &exporter)));
}

void writeObj(const std::string& path, const TexturedMesh& textured)
{
  const fs::path base = fs::path(path).replace_extension();
  const std::string name = base.filename().string();
  const std::unique_ptr<aiScene> scene = makeTexturedScene(textured, name + ".png", {});
  Assimp::Exporter exporter;
  const aiExportDataBlob* obj = exportScene(path, *scene, "obj", &exporter);
  const aiExportDataBlob* mtl = obj->next;
  while (mtl != nullptr && std::string(mtl->name.C_Str()) != "mtl")
    mtl = mtl->next;
  if (mtl == nullptr)
    throw Error(StatusCode::INTERNAL, "no textured mesh for '" + path + "': assimp made no material");
  std::string text = textOf(*obj);
  const std::string library = "mtllib ";
  const std::size_t at = text.find(library);
  if (at == std::string::npos)
    throw Error(StatusCode::INTERNAL, "no textured mesh for '" + path + "': assimp names no material library");
  text.replace(at + library.size(), text.find('\n', at) - at - library.size(), name + ".mtl");

  const std::vector<unsigned char> png = encodePng(textured.texture_bgr);
  base::writeTextFile(base.string() + ".png", std::string(png.begin(), png.end()));
  base::writeTextFile(base.string() + ".mtl", textOf(*mtl));
  base::writeTextFile(path, text);
}
}  // namespace

void writeTexturedMesh(const std::string& path, const TexturedMesh& textured)
{
  const std::string extension = extensionOf(path);
  checkConsistent(path, textured);
  extension == ".glb" ? writeGlb(path, textured) : writeObj(path, textured);
}

TexturedMesh readTexturedMesh(const std::string& path)
{
  extensionOf(path);
  if (!fs::is_regular_file(path))
    throw Error(StatusCode::NOT_FOUND, "textured mesh '" + path + "' does not exist");
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_ValidateDataStructure);
  if (scene == nullptr)
    throw Error(StatusCode::BAD_INPUT, "textured mesh '" + path + "' cannot be read: " + importer.GetErrorString());
  try
  {
    return fromTexturedScene(*scene, fs::path(path).parent_path().string());
  }
  catch (const Error& error)
  {
    throw Error(error.code(), "textured mesh '" + path + "' cannot be used: " + error.what());
  }
}

}  // namespace object_modelling::mesh
