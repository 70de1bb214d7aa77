#pragma once

#include <vector>

#include "object_modelling/alignment/pair_alignment.h"

namespace object_modelling::alignment
{
/// The same spot of the object in two sessions, as a person points it out; metres, each in its session's frame.
struct PointPair
{
  Eigen::Vector3d a, b;
};

/// Pose by three or more pairs of points (Umeyama 1991), then moved into place by shape and colour where that stays
/// near. Throws base::Error (INVALID_ARGUMENT) that names the useless pairs: fewer than three, nearly on a line, or
/// farther apart in one session than in the other.
PairCandidate alignByPoints(const registration::PartialModel& a, const registration::PartialModel& b,
                            const std::vector<PointPair>& pairs, const PairAlignmentOptions& options,
                            base::JobControl& control);

}  // namespace object_modelling::alignment
