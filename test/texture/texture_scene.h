#pragma once

#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"
#include "support/handheld_trajectory.h"
#include "support/synthetic_scene.h"

namespace object_modelling::texture
{
constexpr double BOX_HEIGHT_M = 0.12;
const Eigen::Vector3d BOX_SIZE_M(0.08, 0.1, BOX_HEIGHT_M);

/// Faces of an axis-aligned box in squares of `step_m`, vertices doubled nowhere. Standing on z = 0.
inline mesh::TriangleMesh boxMesh(double step_m, bool with_bottom)
{
  mesh::TriangleMesh mesh;
  std::vector<std::array<long, 3>> keys;
  const auto vertexAt = [&](const Eigen::Vector3d& p)
  {
    const std::array<long, 3> key{ std::lround(p.x() * 1e6), std::lround(p.y() * 1e6), std::lround(p.z() * 1e6) };
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i] == key)
        return static_cast<std::uint32_t>(i);
    keys.push_back(key);
    mesh.vertices.push_back((p + Eigen::Vector3d(0, 0, BOX_HEIGHT_M / 2)).cast<float>());
    return static_cast<std::uint32_t>(keys.size() - 1);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : { -0.5, 0.5 })
    {
      if (axis == 2 && side < 0 && !with_bottom)
        continue;
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const int steps_a = static_cast<int>(std::lround(BOX_SIZE_M[a] / step_m));
      const int steps_b = static_cast<int>(std::lround(BOX_SIZE_M[b] / step_m));
      const auto corner = [&](int i, int j)
      {
        Eigen::Vector3d p;
        p[axis] = side * BOX_SIZE_M[axis];
        p[a] = (static_cast<double>(i) / steps_a - 0.5) * BOX_SIZE_M[a];
        p[b] = (static_cast<double>(j) / steps_b - 0.5) * BOX_SIZE_M[b];
        return vertexAt(p);
      };
      for (int i = 0; i < steps_a; ++i)
        for (int j = 0; j < steps_b; ++j)
        {
          const std::uint32_t p = corner(i, j), q = corner(i + 1, j), r = corner(i + 1, j + 1), s = corner(i, j + 1);
          if (side > 0)
            mesh.triangles.insert(mesh.triangles.end(), { { p, q, r }, { p, r, s } });
          else
            mesh.triangles.insert(mesh.triangles.end(), { { p, r, q }, { p, s, r } });
        }
    }
  mesh::computeNormals(&mesh);
  return mesh;
}

inline test_support::SyntheticScene boxScene()
{
  test_support::SyntheticScene scene;
  scene.objects.push_back(test_support::standingBox(BOX_SIZE_M));
  return scene;
}

/// Twice round the box, from the side and from above; exact poses, masks of the box.
inline std::vector<rgbd::View> roundTheBox(const test_support::SyntheticScene& scene, int count,
                                           const test_support::SensorNoise& noise = {})
{
  std::vector<Eigen::Isometry3d> poses = test_support::orbitPoses(count - count / 2, { 0, 0, 0.06 }, 0.5, 0.3);
  for (const Eigen::Isometry3d& pose : test_support::orbitPoses(count / 2, { 0, 0, 0.06 }, 0.5, 0.9))
    poses.push_back(pose);
  return test_support::renderViews(scene, test_support::vgaCamera(), poses, noise);
}

}  // namespace object_modelling::texture
