#pragma once

#include <cmath>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::test_support
{
/// Box with a corner at `low`, every side cut into n x n squares.
inline void addBox(const Eigen::Vector3f& low, const Eigen::Vector3f& size_m, int n, mesh::TriangleMesh* mesh)
{
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
    {
      const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
        {
          Eigen::Vector3f p = low;
          p[axis] += static_cast<float>(side) * size_m[axis];
          p[u] += size_m[u] * static_cast<float>(i) / static_cast<float>(n);
          p[v] += size_m[v] * static_cast<float>(j) / static_cast<float>(n);
          mesh->vertices.push_back(p);
        }
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
        {
          const auto a = first + static_cast<std::uint32_t>(i * (n + 1) + j);
          const auto b = a + static_cast<std::uint32_t>(n + 1);
          mesh->triangles.push_back({ a, b, b + 1 });
          mesh->triangles.push_back({ a, b + 1, a + 1 });
          if (side == 0)
            for (std::size_t t = mesh->triangles.size() - 2; t < mesh->triangles.size(); ++t)
              std::swap(mesh->triangles[t][1], mesh->triangles[t][2]);
        }
    }
}

/// No two poses of it look alike.
inline mesh::TriangleMesh lopsidedShape(int n)
{
  mesh::TriangleMesh mesh;
  addBox({ 0, 0, 0 }, { 0.12f, 0.07f, 0.18f }, n, &mesh);
  addBox({ 0.12f, 0.01f, 0.1f }, { 0.04f, 0.02f, 0.05f }, n, &mesh);
  return mesh;
}

inline mesh::TriangleMesh sphere(float radius_m, int rings)
{
  mesh::TriangleMesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const double polar = M_PI * i / rings, turn = 2 * M_PI * j / columns;
      mesh.vertices.push_back(radius_m * Eigen::Vector3d(std::sin(polar) * std::cos(turn),
                                                         std::sin(polar) * std::sin(turn), std::cos(polar))
                                             .cast<float>());
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const auto at = [&](int ring, int column)
      { return static_cast<std::uint32_t>(ring * columns + column % columns); };
      mesh.triangles.push_back({ at(i, j), at(i + 1, j), at(i + 1, j + 1) });
      mesh.triangles.push_back({ at(i, j), at(i + 1, j + 1), at(i, j + 1) });
    }
  return mesh;
}

inline std::vector<Eigen::Vector3d> pointsOf(const mesh::TriangleMesh& mesh)
{
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    points.push_back(vertex.cast<double>());
  return points;
}

inline std::vector<Eigen::Vector3d> moved(const Eigen::Isometry3d& T, std::vector<Eigen::Vector3d> points)
{
  for (Eigen::Vector3d& point : points)
    point = T * point;
  return points;
}

/// 150 degrees about no axis of the shapes, half a metre away.
inline Eigen::Isometry3d farAway()
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(150 * M_PI / 180, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.3, -0.36, 0.2);
  return T;
}

}  // namespace object_modelling::test_support
