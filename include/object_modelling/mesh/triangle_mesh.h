#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace object_modelling::mesh
{
/// Indexed triangles, counter-clockwise seen from outside. Metres.
struct TriangleMesh
{
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;                   ///< per vertex, unit length; empty or as many as vertices
  std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colors;  ///< per vertex, RGB; empty or as many as vertices
  std::vector<std::uint8_t> seen;  ///< per vertex: 0 where the surface was closed and no camera saw it; empty: all seen
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices

  bool empty() const { return triangles.empty(); }
};

/// Area-weighted vertex normals from the triangles.
void computeNormals(TriangleMesh* mesh);
void transform(const Eigen::Isometry3d& T_target_source, TriangleMesh* mesh);
double surfaceArea_m2(const TriangleMesh& mesh);

}  // namespace object_modelling::mesh
