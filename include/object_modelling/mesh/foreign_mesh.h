#pragma once

#include <string>

#include "object_modelling/mesh/textured_mesh.h"

namespace object_modelling::mesh
{
/// A mesh that somebody else has made, in whatever unit it is in: OBJ, PLY, STL, glTF (.glb, .gltf) and what else
/// assimp reads, all its parts as one; with its texture where it has a single one (else `uvs` and the texture are
/// empty). Vertices at one place are joined, triangles without area left out; vertex colours where the file or the
/// texture has some. Throws base::Error (NOT_FOUND; BAD_INPUT with the reason: damaged, no triangles, a vertex that is
/// not finite).
TexturedMesh readForeignMesh(const std::string& path);

/// Every triangle cut into four until no edge is longer than `max_edge_m` or another cut would make more than
/// `max_triangles`. Colours and places on the texture are interpolated, normals made anew.
TexturedMesh subdivided(TexturedMesh textured, double max_edge_m, std::size_t max_triangles);

}  // namespace object_modelling::mesh
