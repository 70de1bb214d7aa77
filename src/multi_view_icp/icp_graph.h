#pragma once

#include <vector>

#include <Eigen/Core>

#include "object_modelling/multi_view_icp/multi_view_icp.h"

namespace object_modelling::multi_view_icp
{
/// Two views, by index, that see the same surface.
struct IcpEdge
{
  int a = -1, b = -1;  ///< a < b
  double overlap_ratio = 0;
};

/// Each view with its best partners by predicted overlap, of another body. Ordered by (a, b).
std::vector<IcpEdge> overlapGraph(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options);

/// Each view with its best partners by `ratio`: (a, b) is the share of b's surface that a sees, in [0, 1]; the smaller
/// of both ways counts. Half of them those that share most, half spread over the others, which hold the whole together
/// better than neighbours alone do. Ordered by (a, b).
std::vector<IcpEdge> edgesBetweenPartners(const Eigen::MatrixXd& ratio, double min_ratio, int max_partners);

/// The sets of views that the edges, and their bodies, connect; each ascending.
std::vector<std::vector<int>> connectedSets(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges);

/// The largest of them that has views of more than one body; empty if none has: nothing moves against anything
/// then.
std::vector<int> connectedViews(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges);

/// Which body each view is of: its session's, or one of its own.
std::vector<int> bodiesOf(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options);

}  // namespace object_modelling::multi_view_icp
