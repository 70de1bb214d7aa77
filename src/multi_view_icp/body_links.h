#pragma once

#include <vector>

#include "icp_graph.h"
#include "icp_view.h"

namespace object_modelling::multi_view_icp
{
/// Pairs of views of different sessions that have surface in common as the sessions are placed, each view with its
/// best partners. `overlap_ratio` is the share of the points of one that lie on the other's surface. It is measured,
/// not predicted from the directions of the views: an object that was turned over is seen from above and from
/// below, and its sides by both. Two bodies that share too little to be held together by it have no pairs.
std::vector<IcpEdge> linksBetweenBodies(const std::vector<rgbd::View>& views, const std::vector<IcpView>& icp_views,
                                        const MultiViewIcpOptions& options);

}  // namespace object_modelling::multi_view_icp
