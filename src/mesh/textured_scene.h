#pragma once

#include <memory>
#include <string>
#include <vector>

#include <assimp/scene.h>

#include "object_modelling/mesh/textured_mesh.h"

namespace object_modelling::mesh
{
/// As assimp has it: a vertex per place on the texture. `texture_file` is what the material names: the name of a file,
/// or "*0" for the image inside, whose bytes are then `embedded_png`.
std::unique_ptr<aiScene> makeTexturedScene(const TexturedMesh& textured, const std::string& texture_file,
                                           const std::vector<unsigned char>& embedded_png);

/// The other way; `folder` is where files of textures lie. Throws base::Error (BAD_INPUT), with the reason
/// in the message.
TexturedMesh fromTexturedScene(const aiScene& scene, const std::string& folder);

}  // namespace object_modelling::mesh
