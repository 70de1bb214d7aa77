#pragma once

#include <vector>

#include <Eigen/Core>

#include "object_modelling/multi_view_icp/multi_view_icp.h"

namespace object_modelling::multi_view_icp
{
/// Two keyframes, by index, that see the same surface.
struct IcpEdge
{
  int a = -1, b = -1;  ///< a < b
  double overlap_ratio = 0;
};

/// Each keyframe with its best partners by predicted overlap, of another body. Ordered by (a, b).
std::vector<IcpEdge> overlapGraph(const std::vector<rgbd::Keyframe>& keyframes, const MultiViewIcpOptions& options);

/// Each keyframe with its best partners by `ratio`, which tells for (a, b) how much of b's surface a sees and counts as
/// the smaller of both ways: half of them those that share most, half spread over the others, which hold the whole
/// together better than neighbours alone do. Ordered by (a, b).
std::vector<IcpEdge> edgesBetweenPartners(const Eigen::MatrixXd& ratio, double min_ratio, int max_partners);

/// The sets of keyframes that the edges, and their bodies, connect; each ascending.
std::vector<std::vector<int>> connectedSets(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges);

/// The largest of them that has keyframes of more than one body; empty if none has: nothing moves against anything
/// then.
std::vector<int> connectedKeyframes(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges);

/// The bodies of the options; each keyframe one of its own if they name none.
std::vector<int> bodiesOf(const MultiViewIcpOptions& options, std::size_t keyframe_count);

}  // namespace object_modelling::multi_view_icp
