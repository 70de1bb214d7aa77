#pragma once

#include <string>
#include <vector>

#include "object_modelling/mesh/triangle_mesh.h"

namespace object_modelling::mesh
{
/// Writes metres, normals and vertex colours, PLY also what cameras saw (uchar seen) and `sigmas_m`, one per vertex or
/// none (float sigma_m). The format goes by the extension: .ply (binary) or .obj ("v x y z r g b"; smooth normals are
/// added where the mesh has none). The file appears complete or not at all. Throws base::Error (STORAGE naming path and
/// cause; INVALID_ARGUMENT for another extension, an empty or inconsistent mesh).
void writeMesh(const std::string& path, const TriangleMesh& mesh, const std::vector<float>& sigmas_m = {});
/// Polygons come as triangles, several parts as one mesh, textures are left out. Throws base::Error (NOT_FOUND;
/// BAD_INPUT with the reason: damaged, no triangles, indices out of range).
TriangleMesh readMesh(const std::string& path);

}  // namespace object_modelling::mesh
