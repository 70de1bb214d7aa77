#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
void computeNormals(TriangleMesh* mesh)
{
  mesh->normals.assign(mesh->vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh->triangles)
  {
    const Eigen::Vector3f& origin = mesh->vertices[a];
    // The cross product's length is twice the area: the weighting comes by itself.
    const Eigen::Vector3f normal = (mesh->vertices[b] - origin).cross(mesh->vertices[c] - origin);
    for (const std::uint32_t vertex : { a, b, c })
      mesh->normals[vertex] += normal;
  }
  for (Eigen::Vector3f& normal : mesh->normals)
  {
    const float length = normal.norm();
    if (length > 0)
      normal /= length;
    else
      normal = Eigen::Vector3f::UnitZ();  // vertex of no (or only degenerate) triangles
  }
}

void transform(const Eigen::Isometry3d& T_target_source, TriangleMesh* mesh)
{
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  for (Eigen::Vector3f& vertex : mesh->vertices)
    vertex = T * vertex;
  for (Eigen::Vector3f& normal : mesh->normals)
    normal = T.linear() * normal;
}

double surfaceArea_m2(const TriangleMesh& mesh)
{
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
  {
    const Eigen::Vector3d origin = mesh.vertices[a].cast<double>();
    const Eigen::Vector3d side = mesh.vertices[b].cast<double>() - origin;
    area += 0.5 * side.cross(mesh.vertices[c].cast<double>() - origin).norm();
  }
  return area;
}

}  // namespace object_modelling::mesh
