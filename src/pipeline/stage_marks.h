#pragma once

#include <optional>

#include "object_modelling/pipeline/session_refinement.h"
#include "object_modelling/segmentation/object_mask_propagator.h"

namespace object_modelling::pipeline
{
/// A session's mark of its refinement: whose poses were taken, what was compared, and the options.
keyframes::StageMark refinementMark(const RefinementOptions& options, const SessionRefinement& refined);

/// A session's mark of its segmentation: whether a person named the object, and where.
keyframes::StageMark segmentationMark(const std::optional<Eigen::Vector3d>& seed_point_session,
                                      const segmentation::ObjectMaskPropagatorOptions& options);

}  // namespace object_modelling::pipeline
