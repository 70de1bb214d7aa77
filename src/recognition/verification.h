#pragma once

#include "object_modelling/recognition/candidate.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"

namespace object_modelling::recognition
{
constexpr int VERIFICATION_STEP_PX = 2;  ///< the image is thinned by this

Verification verify(const Scene& scene, const ObjectKnowledge& object, const Eigen::Isometry3d& T_camera_model);

constexpr float LEAST_SCORE = -8;  ///< of a candidate

/// Logarithm of the odds that a candidate is right, by logistic regression on its evidence.
float scoreOf(const Verification& verification, const PoseHypothesis& hypothesis);

/// Chance that the best candidate of a place is right; `rival_score` is that of the best one there that differs.
float confidenceOf(const Candidate& candidate, float rival_score);

}  // namespace object_modelling::recognition
