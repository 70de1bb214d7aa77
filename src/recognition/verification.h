#pragma once

#include "object_modelling/recognition/candidate.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"

namespace object_modelling::recognition
{
constexpr int VERIFICATION_STEP_PX = 2;  ///< the image is thinned by this

Verification verify(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model);

}  // namespace object_modelling::recognition
