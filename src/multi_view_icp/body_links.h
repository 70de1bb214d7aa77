#pragma once

#include <vector>

#include "icp_graph.h"
#include "icp_view.h"

namespace object_modelling::multi_view_icp
{
/// Pairs of keyframes of different bodies that have surface in common as the bodies are placed, each keyframe with its
/// best partners. `overlap_ratio` is the share of the points of one that lie on the other's surface. It is measured,
/// not predicted from the directions of the views: an object that was turned over is seen from above and from below,
/// and its sides by both. Two bodies that share too little to be held together by it have no pairs.
std::vector<IcpEdge> linksBetweenBodies(const std::vector<rgbd::Keyframe>& keyframes, const std::vector<IcpView>& views,
                                        const MultiViewIcpOptions& options);

}  // namespace object_modelling::multi_view_icp
