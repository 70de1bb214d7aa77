#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

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
using Point = pcl::PointXYZRGBNormal;

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

/// The writer takes every field of the cloud for a property of the file.
void keepFields(bool normals, bool colors, pcl::PCLPointCloud2* cloud)
{
  const auto unwanted = [&](const pcl::PCLPointField& field)
  {
    return field.name == "curvature" || (!colors && field.name == "rgb") ||
           (!normals && field.name.rfind("normal_", 0) == 0);
  };
  cloud->fields.erase(std::remove_if(cloud->fields.begin(), cloud->fields.end(), unwanted), cloud->fields.end());
}

/// What no camera saw is transparent: a property of its own is none that the library would write.
void makeTransparent(pcl::PCLPointCloud2* cloud)
{
  for (pcl::PCLPointField& field : cloud->fields)
    if (field.name == "rgb")
    {
      field.name = "rgba";
      field.datatype = pcl::PCLPointField::UINT32;
    }
}

}  // namespace

void writePly(const std::string& path, const TriangleMesh& mesh)
{
  const bool normals = !mesh.normals.empty(), colors = !mesh.colors.empty();
  const bool marked = colors && !mesh.seen.empty();
  pcl::PointCloud<Point> points;
  points.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
  {
    points[i].getVector3fMap() = mesh.vertices[i];
    if (normals)
      points[i].getNormalVector3fMap() = mesh.normals[i];
    if (colors)
    {
      points[i].r = mesh.colors[i][0];
      points[i].g = mesh.colors[i][1];
      points[i].b = mesh.colors[i][2];
      points[i].a = marked && mesh.seen[i] == 0 ? 0 : 255;
    }
  }
  pcl::PolygonMesh polygons;
  pcl::toPCLPointCloud2(points, polygons.cloud);
  keepFields(normals, colors, &polygons.cloud);
  if (marked)
    makeTransparent(&polygons.cloud);
  polygons.polygons.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    polygons.polygons[i].vertices.assign(mesh.triangles[i].begin(), mesh.triangles[i].end());

  // The library does not look at the state of its stream: a full disk shows in the size of the file only.
  const std::size_t vertex_bytes = 12 + (normals ? 12 : 0) + (colors ? 3 : 0) + (marked ? 1 : 0), triangle_bytes = 13;
  const std::size_t body_bytes = mesh.vertices.size() * vertex_bytes + mesh.triangles.size() * triangle_bytes;
  std::error_code error;
  if (pcl::io::savePLYFileBinary(path, polygons) != 0 || std::filesystem::file_size(path, error) < body_bytes || error)
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
  if (!hasField(polygons.cloud, "x") || !hasField(polygons.cloud, "y") || !hasField(polygons.cloud, "z"))
    throw base::Error(base::StatusCode::BAD_INPUT, "'" + path + "': its vertices have no float x, y, z");

  pcl::PointCloud<pcl::PointXYZ> points;
  pcl::fromPCLPointCloud2(polygons.cloud, points);
  TriangleMesh mesh;
  for (const auto& point : points)
    mesh.vertices.push_back(point.getVector3fMap());
  if (normals)
  {
    const std::size_t x = offsetOf(polygons.cloud, "normal_x"), y = offsetOf(polygons.cloud, "normal_y"),
                      z = offsetOf(polygons.cloud, "normal_z");
    for (std::size_t i = 0; i < points.size(); ++i)
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
      if (marked)
        mesh.seen.push_back(color.a != 0 ? 1 : 0);
    }
  }
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
