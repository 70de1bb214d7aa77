#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/surface/texturing.h"

namespace object_modelling::pipeline
{
/// database::ObjectModel::quality: figures by name, units in the names.
std::map<std::string, double> qualityFigures(std::size_t view_count, const fusion::CloudFusionResult& fused,
                                             const geometry::TriangleMesh& mesh, const surface::TextureResult& texture);

}  // namespace object_modelling::pipeline
