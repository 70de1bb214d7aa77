#pragma once

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::alignment
{
/// Places sessions by the accepted edges: the maximum spanning tree on their probability (Kruskal 1956); an edge that
/// contradicts the tree is left out with the reason, and so is a weak edge of the tree that it contradicts. Sets `used`
/// and `reason` of the edges. The largest connected part is placed, in the frame of its first session.
std::vector<SessionPlacement> placeByEdges(const std::vector<std::string>& session_ids,
                                           std::vector<AlignmentEdge>* edges);

}  // namespace object_modelling::alignment
