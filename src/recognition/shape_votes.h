#pragma once

#include <memory>
#include <vector>

#include "deadline.h"
#include "object_modelling/recognition/candidate.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "object_modelling/recognition/recogniser.h"
#include "scene.h"

namespace object_modelling::recognition
{
/// Poses that point pairs vote for, of the likely objects in every cluster of the scene. On all cores; the same order
/// always. After the deadline clusters are left out.
std::vector<PoseHypothesis> posesByShape(const Scene& scene,
                                         const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects,
                                         const RecogniserOptions& options, const Deadline& deadline);

}  // namespace object_modelling::recognition
