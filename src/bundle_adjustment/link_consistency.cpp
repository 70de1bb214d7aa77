#include "link_consistency.h"

#include <cmath>
#include <map>
#include <utility>

#include "object_modelling/features/relative_pose.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
// Drifts that a link may be off once the loop is relaxed. A loop of 30 steps that ends 12 % of the distance off passes;
// a match that is wrong by one period of a pattern (some cm) within a well-tracked stretch does not.
constexpr double MAX_DRIFTS = 4.0;
constexpr double SUPPORT_GATE_SIGMAS = 8.0;
constexpr double MIN_SUPPORT_RATIO = 0.5;

/// Centre and RMS radius of points.
class Patch
{
public:
  void add(const Eigen::Vector3d& p)
  {
    sum_ += p;
    squared_ += p.squaredNorm();
    ++count_;
  }
  PoseEdge edge(int a, int b, const Eigen::Isometry3d& T_a_b) const
  {
    // Without any depth the scale is unknown; a surface at 1 m does for the relative weights.
    const double n = std::max(1, count_);
    const Eigen::Vector3d center = count_ > 0 ? Eigen::Vector3d(sum_ / n) : Eigen::Vector3d::UnitZ();
    const double radius_m = std::sqrt(std::max(0.0, squared_ / n - center.squaredNorm()));
    PoseEdge result;
    result.a = a;
    result.b = b;
    result.T_a_b = T_a_b;
    result.points_b = patchCorners(center, std::max(radius_m, 0.05 * center.norm()));
    result.sigma_m = DRIFT_RATIO * center.norm();
    return result;
  }

private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double squared_ = 0;
  int count_ = 0;
};

}  // namespace

PoseEdge edgeOfLink(const VerifiedLink& link, const std::vector<rgbd::Keyframe>& keyframes)
{
  Patch patch;
  for (const LinkedPoint& point : link.points)
    patch.add(keyframes[link.b].frame.camera.unproject(point.pixel_b.x(), point.pixel_b.y(), point.depth_b_m));
  return patch.edge(link.a, link.b, link.T_a_b);
}

std::vector<PoseEdge> edgesOfTracker(const std::vector<SightGroup>& groups,
                                     const std::vector<rgbd::Keyframe>& keyframes, int min_shared)
{
  struct Shared
  {
    int count = 0;
    Patch patch;
  };
  std::map<std::pair<int, int>, Shared> shared;
  for (const SightGroup& group : groups)
  {
    for (std::size_t j = 0; j < group.sights.size(); ++j)
    {
      const Sight& b = group.sights[j];
      for (std::size_t i = 0; i < j; ++i)
      {
        Shared& pair = shared[{ group.sights[i].keyframe, b.keyframe }];
        ++pair.count;
        if (b.depth_m > 0)
          pair.patch.add(keyframes[b.keyframe].frame.camera.unproject(b.pixel.x(), b.pixel.y(), b.depth_m));
      }
    }
  }
  std::vector<PoseEdge> edges;
  for (const auto& [pair, common] : shared)
  {
    if (common.count < min_shared)
      continue;
    const auto [a, b] = pair;
    edges.push_back(common.patch.edge(a, b, keyframes[a].T_session_camera.inverse() * keyframes[b].T_session_camera));
  }
  return edges;
}

std::vector<Eigen::Isometry3d> relaxWithLinks(const std::vector<PoseEdge>& tracker_edges,
                                              const std::vector<PoseEdge>& link_edges, int fixed,
                                              const std::vector<Eigen::Isometry3d>& T_session_camera,
                                              std::vector<bool>* active)
{
  std::vector<Eigen::Isometry3d> relaxed;
  while (true)
  {
    std::vector<PoseEdge> edges = tracker_edges;
    for (std::size_t i = 0; i < link_edges.size(); ++i)
      if ((*active)[i])
        edges.push_back(link_edges[i]);
    relaxed = T_session_camera;
    relaxPoseGraph(edges, fixed, &relaxed);
    int worst = -1;
    double worst_error = MAX_DRIFTS;
    for (std::size_t i = 0; i < link_edges.size(); ++i)
    {
      const double error = edgeError_m(link_edges[i], relaxed) / link_edges[i].sigma_m;
      if (!(*active)[i] || error <= worst_error)
        continue;
      worst = static_cast<int>(i);
      worst_error = error;
    }
    if (worst < 0)
      return relaxed;
    (*active)[worst] = false;
  }
}

bool supports(const VerifiedLink& link, const std::vector<rgbd::Keyframe>& keyframes,
              const std::vector<Eigen::Isometry3d>& T_session_camera)
{
  const geometry::PinholeCamera& camera_a = keyframes[link.a].frame.camera;
  const geometry::PinholeCamera& camera_b = keyframes[link.b].frame.camera;
  std::vector<features::PointPair> pairs;
  for (const LinkedPoint& point : link.points)
  {
    pairs.push_back({ camera_a.unproject(point.pixel_a.x(), point.pixel_a.y(), point.depth_a_m),
                      camera_b.unproject(point.pixel_b.x(), point.pixel_b.y(), point.depth_b_m), point.sigma_a_px,
                      point.sigma_b_px });
  }
  const Eigen::Isometry3d T_a_b = T_session_camera[link.a].inverse() * T_session_camera[link.b];
  const std::vector<int> inliers =
      features::inliersOf(T_a_b, pairs, keyframes[link.a].frame, keyframes[link.b].frame, SUPPORT_GATE_SIGMAS);
  return static_cast<double>(inliers.size()) >= MIN_SUPPORT_RATIO * static_cast<double>(pairs.size());
}

}  // namespace object_modelling::bundle_adjustment
