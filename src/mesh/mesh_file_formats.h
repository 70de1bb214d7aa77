#pragma once

#include <string>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// Each format writes to the path it is given, whatever its extension, and throws base::Error (STORAGE) if the whole
/// mesh did not get there; reading throws base::Error (BAD_INPUT) with the library's reason.
void writePly(const std::string& path, const TriangleMesh& mesh, const std::vector<float>& sigmas_m);
TriangleMesh readPly(const std::string& path);
void writeObj(const std::string& path, const TriangleMesh& mesh);
TriangleMesh readObj(const std::string& path);

}  // namespace object_modelling::mesh
