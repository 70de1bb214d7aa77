#pragma once

#include <vector>

#include "object_modelling/refinement/multi_view_icp.h"

namespace object_modelling::refinement
{
/// Two keyframes, by index, that see the same surface.
struct IcpEdge
{
  int a = -1, b = -1;  ///< a < b
  double overlap_ratio = 0;
};

/// Each keyframe with its best partners by predicted overlap: half of them those that overlap most, half spread over
/// the others, which hold the whole together better than neighbours alone do. Ordered by (a, b).
std::vector<IcpEdge> overlapGraph(const std::vector<rgbd::Keyframe>& keyframes, const MultiViewIcpOptions& options);

/// The largest set of keyframes that the edges, and their bodies, connect; ascending.
std::vector<int> connectedKeyframes(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges);

/// The bodies of the options; each keyframe one of its own if they name none.
std::vector<int> bodiesOf(const MultiViewIcpOptions& options, std::size_t keyframe_count);

}  // namespace object_modelling::refinement
