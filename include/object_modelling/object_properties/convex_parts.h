#pragma once

#include <string>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::object_properties
{
struct ConvexPartsOptions
{
  double max_concavity_m = 0.005;     ///< the depth of what a part may fill in, for small objects ...
  double max_concavity_ratio = 0.03;  ///< ... in the diameter, for large ones; the greater of the two counts
  int max_parts = 16;
  int max_vertices = 64;  ///< of a part
  std::vector<std::string> violations() const;
};

/// Convex bodies that cover a surface and fill no hollow deeper than the tolerance, for collision checks: the object is
/// cut by planes across its box's axes where that takes most volume from the parts' hulls, the part with the deepest
/// hollow first, and parts whose common hull is within the tolerance are joined again. Depth is measured along the
/// surface's normal up to the part's hull (as by Mamou and Ghorbel, 2009). Each part is the hull of the surface within
/// it, or of some of its extreme points where there are too many. Frame of the mesh; the largest part first. None for a
/// mesh without volume. Throws base::Error (INVALID_ARGUMENT) for broken options.
std::vector<mesh::TriangleMesh> convexParts(const mesh::TriangleMesh& mesh, const ConvexPartsOptions& options = {});

}  // namespace object_modelling::object_properties
