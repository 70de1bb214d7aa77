#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::object_properties
{
/// What the figures are of.
enum class Solid
{
  MESH,         ///< the mesh, which is closed
  CLOSED_MESH,  ///< the mesh with a flat lid on every hole
  HULL          ///< its convex hull: the mesh encloses no sane volume even so
};

struct MassOptions
{
  double density_kg_m3 = 500;  ///< a guess: between packed food and filled bottles
  double mass_kg = 0;          ///< as weighed; 0: volume times density
  std::vector<std::string> violations() const;
};

/// Of a solid of uniform density, in the frame of its mesh.
struct MassProperties
{
  bool closed = false;  ///< no edge of the mesh is a border
  Solid of = Solid::MESH;
  double volume_m3 = 0;
  Eigen::Vector3d center_of_mass_m = Eigen::Vector3d::Zero();
  /// About the centre of mass, along the axes of the frame, for a density of 1 kg/m3.
  Eigen::Matrix3d inertia_per_density_m5 = Eigen::Matrix3d::Zero();
  double density_kg_m3 = 0;
  double mass_kg = 0;
};

/// Integrals over the volume as sums over the triangles (Mirtich, Fast and accurate computation of polyhedral mass
/// properties, 1996), each taken as the foot of a tetrahedron. Vertices at one place count as one. All zero for a mesh
/// whose hull has no volume. Throws base::Error (INVALID_ARGUMENT) for broken options.
MassProperties massProperties(const mesh::TriangleMesh& mesh, const MassOptions& options = {});

}  // namespace object_modelling::object_properties
