#pragma once

#include <vector>

#include "icp_equations.h"
#include "icp_graph.h"
#include "icp_system.h"

namespace object_modelling::multi_view_icp
{
/// All views with their overlaps: matches, equations and errors at given poses. Pairs are worked on in parallel,
/// each into a place of its own, and added up in order, so that the threads do not show in the sums.
class IcpProblem
{
public:
  IcpProblem(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options, std::vector<IcpEdge> edges,
             base::JobControl* control);

  const std::vector<IcpView>& views() const { return views_; }
  const std::vector<IcpEdge>& edges() const { return edges_; }
  void add(const std::vector<IcpEdge>& edges);
  /// Forgets the edges of a view.
  void leaveOut(int view);

  /// Finds partners, at these poses, for what follows.
  void match(const std::vector<Eigen::Isometry3d>& T_world_camera, const IcpStage& stage);
  double cost(const std::vector<Eigen::Isometry3d>& T_world_camera) const;
  /// For motions on the left of each T_world_camera.
  std::vector<PairEquations> equations(const std::vector<Eigen::Isometry3d>& T_world_camera) const;
  /// What noise alone brings into them (see icpNoise).
  std::vector<geometry::Matrix6d> noise(const std::vector<Eigen::Isometry3d>& T_world_camera) const;
  /// Of each edge, both directions together; weights are those at `T_world_camera_weights`.
  std::vector<IcpError> errors(const std::vector<Eigen::Isometry3d>& T_world_camera,
                               const std::vector<Eigen::Isometry3d>& T_world_camera_weights) const;
  /// Share of each view's points in view of its partners, and theirs in view of it, that fit within noise.
  std::vector<double> fittingRatios() const;

private:
  /// Calls visit(edge, direction, reference, moved) for each directed pair.
  template <typename Visit>
  void forDirectedPairs(Visit visit) const;

  const MultiViewIcpOptions& options_;
  std::vector<IcpEdge> edges_;
  std::vector<IcpView> views_;
  std::vector<NearestPoints> nearest_;
  std::vector<IcpMatches> matches_;  ///< b's points in a, then a's points in b, for each edge
  IcpLoss loss_;
};

}  // namespace object_modelling::multi_view_icp
