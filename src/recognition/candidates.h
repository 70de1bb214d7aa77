#pragma once

#include <memory>
#include <vector>

#include "hypothesis.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"
#include "verification.h"

namespace object_modelling::recognition
{
using KnownObjects = std::vector<std::shared_ptr<const ObjectKnowledge>>;

/// A hypothesis that was aligned with the scene, and how well it then fits.
struct Candidate
{
  PoseHypothesis hypothesis;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();  ///< of its pose
  Verification verification;
  float confidence = 0;
};

/// Aligns and verifies, on all cores; in the order given.
std::vector<Candidate> judged(const Scene& scene, const KnownObjects& objects,
                              const std::vector<PoseHypothesis>& hypotheses);

/// Those that fit in shape, turned about the axes of their box as far as the shape fits as well: what shape leaves
/// open, texture decides.
std::vector<Candidate> turned(const Scene& scene, const KnownObjects& objects,
                              const std::vector<Candidate>& candidates);

/// Most confident first, without those that are nearly at the pose of a better one.
std::vector<Candidate> distinct(const KnownObjects& objects, std::vector<Candidate> candidates);

}  // namespace object_modelling::recognition
