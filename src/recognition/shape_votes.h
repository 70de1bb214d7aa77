#pragma once

#include <memory>
#include <vector>

#include "hypothesis.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "object_modelling/recognition/recogniser.h"
#include "scene.h"

namespace object_modelling::recognition
{
/// Poses that point pairs vote for, of every object in every cluster of the scene. On all cores; the same order always.
std::vector<PoseHypothesis> posesByShape(const Scene& scene,
                                         const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects,
                                         const RecogniserOptions& options);

}  // namespace object_modelling::recognition
