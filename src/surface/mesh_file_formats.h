#pragma once

#include <string>

#include "object_modelling/geometry/triangle_mesh.h"

namespace object_modelling::surface
{
/// Each format writes to the path it is given, whatever its extension, and throws base::Error (STORAGE) if the whole
/// mesh did not get there; reading throws base::Error (BAD_INPUT) with the library's reason.
void writePly(const std::string& path, const geometry::TriangleMesh& mesh);
geometry::TriangleMesh readPly(const std::string& path);
void writeObj(const std::string& path, const geometry::TriangleMesh& mesh);
geometry::TriangleMesh readObj(const std::string& path);

}  // namespace object_modelling::surface
