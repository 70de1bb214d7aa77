#pragma once

#include <vector>

#include "edge_graph.h"

namespace object_modelling::alignment
{
/// Poses of each edge, T_a_b, that the best poses of two others imply, T_a_c * T_c_b, where neither is improbable and
/// the edge does not hold the pose already: the most probable ones, a bounded number. None of an edge that a person
/// decided.
std::vector<std::vector<Eigen::Isometry3d>> cyclePoses(const EdgeGraph& graph);

}  // namespace object_modelling::alignment
