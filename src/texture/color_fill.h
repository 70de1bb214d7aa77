#pragma once

#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::texture
{
/// Gives the vertices that are not known the colours of a membrane stretched between the known ones (Laplace's equation
/// on the edges of the mesh). Parts without any known vertex get the mean colour of all known ones, gray if there is
/// none. Both vectors are per vertex.
void fillHarmonically(const mesh::TriangleMesh& mesh, const std::vector<char>& known,
                      std::vector<Eigen::Vector3f>* colors);

}  // namespace object_modelling::texture
