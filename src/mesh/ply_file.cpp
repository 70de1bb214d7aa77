#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "mesh_file_formats.h"
#include "object_modelling/base/status.h"

namespace object_modelling::mesh
{
namespace
{
bool hasField(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  return std::any_of(cloud.fields.begin(), cloud.fields.end(),
                     [&](const pcl::PCLPointField& field) { return field.name == name; });
}

std::size_t offsetOf(const pcl::PCLPointCloud2& cloud, const std::string& name)
{
  return std::find_if(cloud.fields.begin(), cloud.fields.end(),
                      [&](const pcl::PCLPointField& field) { return field.name == name; })
      ->offset;
}

float floatAt(const pcl::PCLPointCloud2& cloud, std::size_t point, std::size_t offset)
{
  float value;
  std::memcpy(&value, &cloud.data[point * cloud.point_step + offset], sizeof(value));
  return value;
}

/// Coordinates as floats or doubles, whichever the file has.
std::vector<Eigen::Vector3f> placesOf(const std::string& path, const pcl::PCLPointCloud2& cloud)
{
  std::vector<Eigen::Vector3f> places(static_cast<std::size_t>(cloud.width) * cloud.height);
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::string name(1, "xyz"[axis]);
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [&](const pcl::PCLPointField& candidate) { return candidate.name == name; });
    const bool doubles = field != cloud.fields.end() && field->datatype == pcl::PCLPointField::FLOAT64;
    if (field == cloud.fields.end() || (!doubles && field->datatype != pcl::PCLPointField::FLOAT32))
      throw base::Error(base::StatusCode::BAD_INPUT, "'" + path + "': its vertices have no float or double x, y, z");
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      double value = 0;
      if (doubles)
        std::memcpy(&value, &cloud.data[i * cloud.point_step + field->offset], sizeof(value));
      places[i][axis] = doubles ? static_cast<float>(value) : floatAt(cloud, i, field->offset);
    }
  }
  return places;
}

/// Of the field "seen", an unsigned byte: 0 where it is not.
std::vector<std::uint8_t> marksOf(const pcl::PCLPointCloud2& cloud)
{
  const std::size_t offset = offsetOf(cloud, "seen"), count = static_cast<std::size_t>(cloud.width) * cloud.height;
  std::vector<std::uint8_t> seen(count, 1);
  for (std::size_t i = 0; i < count; ++i)
    seen[i] = cloud.data[i * cloud.point_step + offset] != 0 ? 1 : 0;
  return seen;
}

template <typename Value>
void append(const Value* values, std::size_t count, std::string* bytes)
{
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the format is written as it lies in memory");
  bytes->append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

std::string header(const TriangleMesh& mesh, bool sigmas)
{
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty())
    text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colors.empty())
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (sigmas)
    text += "property float sigma_m\n";
  if (!mesh.seen.empty())
    text += "property uchar seen\n";
  return text + "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

void writePly(const std::string& path, const TriangleMesh& mesh, const std::vector<float>& sigmas_m)
{
  std::string bytes = header(mesh, !sigmas_m.empty());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    append(mesh.vertices[i].data(), 3, &bytes);
    if (!mesh.normals.empty())
      append(mesh.normals[i].data(), 3, &bytes);
    if (!mesh.colors.empty())
      append(mesh.colors[i].data(), 3, &bytes);
    if (!sigmas_m.empty())
      append(&sigmas_m[i], 1, &bytes);
    if (!mesh.seen.empty())
      append(&mesh.seen[i], 1, &bytes);
  }
  for (const auto& triangle : mesh.triangles)
  {
    bytes.push_back(3);
    append(triangle.data(), 3, &bytes);
  }
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
    throw base::Error(base::StatusCode::STORAGE, "writing '" + path + "' failed: is the disk full?");
}

TriangleMesh readPly(const std::string& path)
{
  pcl::PolygonMesh polygons;
  if (pcl::io::loadPLYFile(path, polygons) != 0)
    throw base::Error(base::StatusCode::BAD_INPUT, "'" + path + "' is not a PLY file that can be read");
  const bool normals = hasField(polygons.cloud, "normal_x") && hasField(polygons.cloud, "normal_y") &&
                       hasField(polygons.cloud, "normal_z");
  const bool marked = hasField(polygons.cloud, "rgba");
  const bool colors = marked || hasField(polygons.cloud, "rgb");
  TriangleMesh mesh;
  mesh.vertices = placesOf(path, polygons.cloud);
  if (normals)
  {
    const std::size_t x = offsetOf(polygons.cloud, "normal_x"), y = offsetOf(polygons.cloud, "normal_y"),
                      z = offsetOf(polygons.cloud, "normal_z");
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      mesh.normals.push_back(
          { floatAt(polygons.cloud, i, x), floatAt(polygons.cloud, i, y), floatAt(polygons.cloud, i, z) });
  }
  if (colors)
  {
    pcl::PointCloud<pcl::RGB> cloud;
    pcl::fromPCLPointCloud2(polygons.cloud, cloud);
    for (const auto& color : cloud)
    {
      mesh.colors.push_back({ color.r, color.g, color.b });
      if (marked)  // of files of before, which had what no camera saw transparent
        mesh.seen.push_back(color.a != 0 ? 1 : 0);
    }
  }
  if (hasField(polygons.cloud, "seen"))
    mesh.seen = marksOf(polygons.cloud);
  for (const pcl::Vertices& polygon : polygons.polygons)
  {
    for (std::size_t k = 2; k < polygon.vertices.size(); ++k)
    {
      mesh.triangles.push_back({ static_cast<std::uint32_t>(polygon.vertices[0]),
                                 static_cast<std::uint32_t>(polygon.vertices[k - 1]),
                                 static_cast<std::uint32_t>(polygon.vertices[k]) });
    }
  }
  return mesh;
}

}  // namespace object_modelling::mesh
