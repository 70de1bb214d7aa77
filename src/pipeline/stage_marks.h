#pragma once

#include <optional>

#include "object_modelling/pipeline/session_refinement.h"
#include "object_modelling/segmentation/object_mask_propagator.h"

namespace object_modelling::pipeline
{
/// What a session says of its refinement: the method, and the options that change its result.
keyframes::StageMark refinementMark(const RefinementOptions& options);

/// What a session says of its segmentation: whether a person named the object, and where.
keyframes::StageMark segmentationMark(const std::optional<Eigen::Vector3d>& seed_point_session,
                                      const segmentation::ObjectMaskPropagatorOptions& options);

}  // namespace object_modelling::pipeline
