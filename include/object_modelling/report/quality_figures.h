#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/texture/texturing.h"

namespace object_modelling::report
{
/// database::ObjectModel::quality: figures by name, units in the names.
std::map<std::string, double> qualityFigures(std::size_t view_count, const fusion::CloudFusionResult& fused,
                                             const mesh::TriangleMesh& mesh, const texture::TextureResult& texture);

}  // namespace object_modelling::report
