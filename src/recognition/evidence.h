#pragma once

#include "object_modelling/recognition/candidate.h"

namespace object_modelling::recognition
{
constexpr float LEAST_SCORE = -8;  ///< of a candidate

/// Logarithm of the odds that a candidate is right, by logistic regression on its evidence.
float scoreOf(const Verification& verification, const PoseHypothesis& hypothesis);

/// Chance that a candidate is right, which is the best one of its place; by its score and that of its rival.
float confidenceOf(const Candidate& candidate);

}  // namespace object_modelling::recognition
