#pragma once

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::object_properties
{
/// Closed meshes about the origin, without doubled vertices except where said.
mesh::TriangleMesh box(const Eigen::Vector3f& size_m, int squares = 12);
/// A corner at `low`.
mesh::TriangleMesh boxAt(const Eigen::Vector3f& low, const Eigen::Vector3f& size_m, int squares);
/// Axis z.
mesh::TriangleMesh cylinder(float radius_m, float height_m, int sides = 64);
mesh::TriangleMesh ball(float radius_m);
/// A cup open at the top (z), walls and bottom of 4 mm, 80 mm across and 100 mm high; with a handle at +x.
mesh::TriangleMesh mug(bool with_handle = true);

/// Turned and moved about no axis of the solids.
Eigen::Isometry3d awry();

/// The same with one colour, RGB.
void paint(const Eigen::Vector3i& color_rgb, mesh::TriangleMesh* mesh);

}  // namespace object_modelling::object_properties
