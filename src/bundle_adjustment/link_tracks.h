#pragma once

#include <vector>

#include "landmark_map.h"
#include "object_modelling/bundle_adjustment/keyframe_linker.h"

namespace object_modelling::bundle_adjustment
{
/// Joins the points of all links for which `active` is set into landmarks with one sight per keyframe (union-find). A
/// match that would give a landmark two places in one keyframe is left out; of contradicting ones the first counts.
std::vector<SightGroup> linkedSights(const std::vector<VerifiedLink>& links, const std::vector<bool>& active);

}  // namespace object_modelling::bundle_adjustment
