#include <algorithm>
#include <cstring>
#include <filesystem>

#include <pcl/PCLPointCloud2.h>
#include <pcl/PolygonMesh.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "object_modelling/base/file_extension.h"
#include "object_modelling/base/status.h"
#include "object_modelling/evaluation/comparison_files.h"
#include "object_modelling/mesh/mesh_files.h"

namespace object_modelling::evaluation
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

const pcl::PCLPointField& coordinateField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                  [&](const pcl::PCLPointField& candidate) { return candidate.name == name; });
  const bool known = field != cloud.fields.end() &&
                     (field->datatype == pcl::PCLPointField::FLOAT32 || field->datatype == pcl::PCLPointField::FLOAT64);
  if (!known)
    throw Error(StatusCode::BAD_INPUT, "its points have no float or double '" + name + "'");
  const std::size_t bytes = field->datatype == pcl::PCLPointField::FLOAT32 ? sizeof(float) : sizeof(double);
  const std::size_t count = static_cast<std::size_t>(cloud.width) * cloud.height;
  if (field->offset + bytes > cloud.point_step || cloud.data.size() < count * cloud.point_step)
    throw Error(StatusCode::BAD_INPUT, "it promises more points than it holds");
  return *field;
}

float valueAt(const pcl::PCLPointCloud2& cloud, std::size_t point, const pcl::PCLPointField& field)
{
  const std::uint8_t* bytes = cloud.data.data() + point * cloud.point_step + field.offset;
  if (field.datatype == pcl::PCLPointField::FLOAT32)
  {
    float value = 0;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
  }
  double value = 0;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<float>(value);
}

std::vector<Eigen::Vector3f> pointsOf(const pcl::PCLPointCloud2& cloud)
{
  const std::size_t count = static_cast<std::size_t>(cloud.width) * cloud.height;
  const pcl::PCLPointField x = coordinateField(cloud, "x"), y = coordinateField(cloud, "y"),
                           z = coordinateField(cloud, "z");
  std::vector<Eigen::Vector3f> points(count);
  for (std::size_t i = 0; i < count; ++i)
    points[i] = { valueAt(cloud, i, x), valueAt(cloud, i, y), valueAt(cloud, i, z) };
  return points;
}

mesh::TriangleMesh readPlyGeometry(const std::string& path)
{
  pcl::PolygonMesh polygons;
  if (pcl::io::loadPLYFile(path, polygons) != 0)
    throw Error(StatusCode::BAD_INPUT, "it is not a PLY file that can be read");
  mesh::TriangleMesh mesh;
  mesh.vertices = pointsOf(polygons.cloud);
  for (const pcl::Vertices& polygon : polygons.polygons)
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k)
      mesh.triangles.push_back({ static_cast<std::uint32_t>(polygon.vertices[0]),
                                 static_cast<std::uint32_t>(polygon.vertices[k - 1]),
                                 static_cast<std::uint32_t>(polygon.vertices[k]) });
  for (const auto& triangle : mesh.triangles)
    if (*std::max_element(triangle.begin(), triangle.end()) >= mesh.vertices.size())
      throw Error(StatusCode::BAD_INPUT, "a triangle names a vertex that does not exist");
  return mesh;
}

mesh::TriangleMesh readPcdGeometry(const std::string& path)
{
  pcl::PCLPointCloud2 cloud;
  // The reader itself falls over a file without points.
  const bool header = pcl::PCDReader().readHeader(path, cloud) == 0;
  if (!header || cloud.fields.empty() || cloud.width == 0 || cloud.height == 0)
    throw Error(StatusCode::BAD_INPUT, "it is no PCD file with points");
  if (pcl::io::loadPCDFile(path, cloud) != 0)
    throw Error(StatusCode::BAD_INPUT, "it is not a PCD file that can be read");
  mesh::TriangleMesh mesh;
  mesh.vertices = pointsOf(cloud);
  return mesh;
}

mesh::TriangleMesh readByExtension(const std::string& path)
{
  const std::string extension = base::lowerExtension(path);
  if (extension == ".ply")
    return readPlyGeometry(path);
  if (extension == ".pcd")
    return readPcdGeometry(path);
  if (extension == ".obj")
    return mesh::readMesh(path);
  throw Error(StatusCode::INVALID_ARGUMENT, "extension '" + extension + "' is not known; use .ply, .obj or .pcd");
}
}  // namespace

mesh::TriangleMesh readGeometry(const std::string& path, double unit_m)
{
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    throw Error(StatusCode::NOT_FOUND, "'" + path + "' is no file");
  mesh::TriangleMesh mesh;
  try
  {
    mesh = readByExtension(path);
  }
  catch (const Error& error)
  {
    throw Error(error.code(), "'" + path + "': " + error.what());
  }
  catch (const std::exception& error)  // the libraries' own, on files that promise more than they hold
  {
    throw Error(StatusCode::BAD_INPUT, "'" + path + "' cannot be read: " + error.what());
  }
  for (Eigen::Vector3f& vertex : mesh.vertices)
    vertex *= static_cast<float>(unit_m);
  return mesh;
}

}  // namespace object_modelling::evaluation
