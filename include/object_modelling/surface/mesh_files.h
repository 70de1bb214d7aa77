#pragma once

#include <string>

#include "object_modelling/geometry/triangle_mesh.h"

namespace object_modelling::surface
{
/// Writes metres, normals and vertex colours. The format goes by the extension: .ply (binary) or .obj ("v x y z r g
/// b"). Throws base::Error (STORAGE naming path and cause, INVALID_ARGUMENT for another extension or an empty mesh).
void writeMesh(const std::string& path, const geometry::TriangleMesh& mesh);
/// Throws base::Error (NOT_FOUND, BAD_INPUT).
geometry::TriangleMesh readMesh(const std::string& path);

}  // namespace object_modelling::surface
