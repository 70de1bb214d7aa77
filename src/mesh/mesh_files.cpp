#include "object_modelling/mesh/mesh_files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>

#include "mesh_file_formats.h"
#include "object_modelling/base/file_extension.h"
#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
namespace fs = std::filesystem;

enum class Format
{
  PLY,
  OBJ
};

Format formatOf(const std::string& path)
{
  const std::string extension = base::lowerExtension(path);
  if (extension == ".ply")
    return Format::PLY;
  if (extension == ".obj")
    return Format::OBJ;
  throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                    "mesh file '" + path + "': extension '" + extension + "' is not known; use .ply or .obj");
}

/// Empty if the mesh is one that can be written and used.
std::string defectOf(const TriangleMesh& mesh)
{
  if (mesh.vertices.empty() || mesh.triangles.empty())
    return "it has no triangles";
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size())
    return "it has not as many normals as vertices";
  if (!mesh.colors.empty() && mesh.colors.size() != mesh.vertices.size())
    return "it has not as many colours as vertices";
  if (!mesh.seen.empty() && mesh.seen.size() != mesh.vertices.size())
    return "it has not as many marks of what was seen as vertices";
  for (const Eigen::Vector3f& vertex : mesh.vertices)
  {
    if (!vertex.allFinite())
      return "a vertex is not finite";
  }
  for (const auto& triangle : mesh.triangles)
  {
    if (*std::max_element(triangle.begin(), triangle.end()) >= mesh.vertices.size())
      return "a triangle names a vertex that does not exist";
  }
  return {};
}

void checkWritable(const std::string& path, const std::string& part)
{
  errno = 0;
  if (!std::ofstream(part, std::ios::binary))
    throw base::Error(base::StatusCode::STORAGE, "cannot write '" + path + "': " + std::strerror(errno));
}

}  // namespace

void writeMesh(const std::string& path, const TriangleMesh& mesh, const std::vector<float>& sigmas_m)
{
  const Format format = formatOf(path);
  std::string defect = defectOf(mesh);
  if (defect.empty() && !sigmas_m.empty() && sigmas_m.size() != mesh.vertices.size())
    defect = "it has not as many standard deviations as vertices";
  if (!defect.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "no mesh for '" + path + "': " + defect);

  // Written beside its place and renamed, so that no reader gets half a mesh.
  const std::string part = path + ".part";
  checkWritable(path, part);
  try
  {
    format == Format::PLY ? writePly(part, mesh, sigmas_m) : writeObj(part, mesh);
    fs::rename(part, path);
  }
  catch (const fs::filesystem_error& error)
  {
    fs::remove(part);
    throw base::Error(base::StatusCode::STORAGE, "cannot write '" + path + "': " + error.code().message());
  }
  catch (...)
  {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
}

TriangleMesh readMesh(const std::string& path)
{
  const Format format = formatOf(path);
  if (!fs::is_regular_file(path))
    throw base::Error(base::StatusCode::NOT_FOUND, "mesh file '" + path + "' does not exist");
  TriangleMesh mesh;
  try
  {
    mesh = format == Format::PLY ? readPly(path) : readObj(path);
  }
  catch (const base::Error&)
  {
    throw;
  }
  catch (const std::exception& error)  // the libraries' own, on files that promise more than they hold
  {
    throw base::Error(base::StatusCode::BAD_INPUT, "mesh file '" + path + "' cannot be read: " + error.what());
  }
  const std::string defect = defectOf(mesh);
  if (!defect.empty())
    throw base::Error(base::StatusCode::BAD_INPUT, "mesh file '" + path + "' cannot be used: " + defect);
  return mesh;
}

}  // namespace object_modelling::mesh
