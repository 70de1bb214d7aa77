#pragma once

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::alignment
{
/// Places sessions by what was found for each pair, all of it together: a session's pose is as probable as the poses of
/// its pairs with the placed ones that agree with it, against those that do not and against none being right. So an
/// edge that the others contradict is found out, takes another of its poses if they agree with that one, and two edges
/// that alone would be refused carry each other. Sets `used` and `reason` of the edges. Poses are compared where the
/// object is: session frames are at the cameras. The most probable placement of all that are tried is taken, in the
/// frame of its first session; a session that is less probable than `min_probability` is left out, and so are several
/// that bear each other out where what joins them to the rest is.
std::vector<SessionPlacement> placeByEdges(const std::vector<registration::PartialModel>& parts, double min_probability,
                                           std::vector<AlignmentEdge>* edges);

}  // namespace object_modelling::alignment
