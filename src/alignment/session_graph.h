#pragma once

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::alignment
{
/// Places sessions by the accepted edges: the maximum spanning tree on their probability (Kruskal 1956); an edge that
/// contradicts the tree is left out with the reason, and so is a weak edge of the tree that it contradicts. Sets `used`
/// and `reason` of the edges. Poses are compared where the object is: session frames are at the cameras. Of a symmetric
/// object, an edge agrees with the tree by any of its poses that score alike. The largest connected part is placed, in
/// the frame of its first session.
std::vector<SessionPlacement> placeByEdges(const std::vector<PartialModel>& parts, std::vector<AlignmentEdge>* edges);

}  // namespace object_modelling::alignment
