#pragma once

#include <memory>
#include <vector>

#include "deadline.h"
#include "object_modelling/recognition/candidate.h"
#include "object_modelling/recognition/object_knowledge.h"
#include "scene.h"
#include "verification.h"

namespace object_modelling::recognition
{
using KnownObjects = std::vector<std::shared_ptr<const ObjectKnowledge>>;

/// Aligns and verifies, on all cores; in the order given. After the deadline, and where hardly anything fits, the
/// score is the least.
std::vector<Candidate> judged(const Scene& scene, const KnownObjects& objects,
                              const std::vector<PoseHypothesis>& hypotheses, const Deadline& deadline);

/// Those that fit in shape, turned about the axes of their box as far as the shape fits as well: what shape leaves
/// open, texture decides.
std::vector<Candidate> turned(const Scene& scene, const KnownObjects& objects, const std::vector<Candidate>& candidates,
                              const Deadline& deadline);

/// Center of the object's box, camera frame.
Eigen::Vector3d centerOf(const KnownObjects& objects, const Candidate& candidate);

/// Angle (rad) between two poses of one object, over its symmetries.
double turnBetween(const KnownObjects& objects, const Candidate& a, const Candidate& b);

/// Best score first, without those that are nearly at the pose of a better one.
std::vector<Candidate> distinct(const KnownObjects& objects, std::vector<Candidate> candidates);

/// By each one's evidence and that of the best other one at its place; 0 where that is better. Best score first.
void setConfidences(const KnownObjects& objects, std::vector<Candidate>* candidates);

}  // namespace object_modelling::recognition
