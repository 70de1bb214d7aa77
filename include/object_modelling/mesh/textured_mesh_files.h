#pragma once

#include <string>

#include "object_modelling/mesh/textured_mesh.h"

namespace object_modelling::mesh
{
/// The format goes by the extension. .obj: beside it a .mtl and the texture as .png of the same name, the three of them
/// found by their names alone. .glb: binary glTF 2, the texture (PNG) inside. Metres, normals, no light in the
/// material; `seen` is not written. Each file appears complete or not at all, the .obj last. Throws base::Error
/// (STORAGE naming path and cause; INVALID_ARGUMENT for another extension or a textured mesh that is empty or
/// inconsistent).
void writeTexturedMesh(const std::string& path, const TexturedMesh& textured);

/// .obj or .glb with one texture image, whoever wrote it; `seen` stays empty, vertices that texture coordinates kept
/// apart are joined again. Throws base::Error (NOT_FOUND; BAD_INPUT with the reason: damaged, no triangles, no texture
/// coordinates, no image).
TexturedMesh readTexturedMesh(const std::string& path);

}  // namespace object_modelling::mesh
