#pragma once

#include <vector>

#include "edge_graph.h"

namespace object_modelling::alignment
{
/// The maximum spanning tree on the probability, of the edges that agree (Kruskal 1956).
std::vector<int> treeOf(const EdgeGraph& graph, const Placement& placed);

/// Of the edges that agree, those of a spanning tree that would agree least by chance. Which poses they agree by makes
/// no difference, unless other edges imply them.
std::vector<int> rarestTreeOf(const EdgeGraph& graph, const Placement& placed);

/// The sessions on one side of an edge of the tree: those of the smaller side, or the later of two alike.
std::vector<int> cutOff(const EdgeGraph& graph, const std::vector<int>& tree, int cut, const Placement& placed);

/// The sessions that the tree connects to the first one, in its frame.
Placement placedBy(const EdgeGraph& graph, const std::vector<int>& tree, const Placement& near);

}  // namespace object_modelling::alignment
