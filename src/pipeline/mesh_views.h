#pragma once

#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/mesh/textured_mesh.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::pipeline
{
/// What a camera of 640 x 480 would see of a mesh from 42 places evenly around it (an icosahedron's corners and the
/// middles of its edges), without noise. The world is the mesh's frame, with the object's centre at its origin.
std::vector<rgbd::View> renderedViews(const mesh::TexturedMesh& textured, double diameter_m, base::JobControl& control);

}  // namespace object_modelling::pipeline
