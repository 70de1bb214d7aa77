#include "icp_graph.h"

#include <algorithm>
#include <map>
#include <numeric>

#include <opencv2/core/utility.hpp>

#include "object_modelling/base/connectivity.h"
#include "object_modelling/bundle_adjustment/pair_selection.h"

namespace object_modelling::multi_view_icp
{
namespace
{
/// The first `count / 2`, and as many evenly out of the rest.
std::vector<int> spread(const std::vector<int>& sorted, int count)
{
  const int size = static_cast<int>(sorted.size());
  if (size <= count)
    return sorted;
  const int nearest = (count + 1) / 2;
  std::vector<int> chosen(sorted.begin(), sorted.begin() + nearest);
  for (int i = 1; i <= count - nearest; ++i)
    chosen.push_back(sorted[nearest - 1 + i * (size - nearest) / (count - nearest)]);
  return chosen;
}

double overlapOf(const rgbd::View& a, const rgbd::View& b, const bundle_adjustment::KeyframeLinkerOptions& options)
{
  return bundle_adjustment::predictedOverlap(a.frame, b.frame, b.T_world_camera.inverse() * a.T_world_camera, options);
}
}  // namespace

std::vector<IcpEdge> overlapGraph(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options)
{
  bundle_adjustment::KeyframeLinkerOptions prediction;
  prediction.object_only = options.object_only;
  prediction.max_view_angle_rad = options.max_view_angle_rad;
  const int count = static_cast<int>(views.size());
  const std::vector<int> bodies = bodiesOf(views, options);
  Eigen::MatrixXd overlap = Eigen::MatrixXd::Zero(count, count);
  cv::parallel_for_(
      cv::Range(0, count),
      [&](const cv::Range& range)
      {
        for (int a = range.start; a < range.end; ++a)
          for (int b = 0; b < count; ++b)
            if (bodies[a] != bodies[b])
              overlap(a, b) = overlapOf(views[a], views[b], prediction);
      },
      options.threads);
  return edgesBetweenPartners(overlap, options.min_overlap_ratio, options.max_partners);
}

std::vector<IcpEdge> edgesBetweenPartners(const Eigen::MatrixXd& ratio, double min_ratio, int max_partners)
{
  // What one sees of the other's surface, both ways: a near view is a part of a far one.
  const auto shared = [&](int a, int b) { return std::min(ratio(a, b), ratio(b, a)); };
  const int count = static_cast<int>(ratio.rows());
  std::map<std::pair<int, int>, double> edges;
  for (int a = 0; a < count; ++a)
  {
    std::vector<int> partners;
    for (int b = 0; b < count; ++b)
      if (a != b && shared(a, b) >= min_ratio)
        partners.push_back(b);
    std::stable_sort(partners.begin(), partners.end(), [&](int x, int y) { return shared(a, x) > shared(a, y); });
    for (const int b : spread(partners, max_partners))
      edges[std::minmax(a, b)] = shared(a, b);
  }
  std::vector<IcpEdge> graph;
  for (const auto& [pair, shared_ratio] : edges)
    graph.push_back({ pair.first, pair.second, shared_ratio });
  return graph;
}

std::vector<int> bodiesOf(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options)
{
  std::vector<int> bodies(views.size());
  std::iota(bodies.begin(), bodies.end(), 0);
  for (std::size_t k = 0; k < views.size() && options.sessions_as_bodies; ++k)
    bodies[k] = views[k].session_index;
  return bodies;
}

std::vector<std::vector<int>> connectedSets(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges)
{
  const auto count = static_cast<Eigen::Index>(bodies.size());
  Eigen::MatrixXi linked = Eigen::MatrixXi::Zero(count, count);
  for (const IcpEdge& edge : edges)
    linked(edge.a, edge.b) = linked(edge.b, edge.a) = 1;
  for (Eigen::Index a = 0; a < count; ++a)
    for (Eigen::Index b = 0; b < count; ++b)
      if (a != b && bodies[a] == bodies[b])
        linked(a, b) = 1;
  return base::components(linked, 1);
}

std::vector<int> connectedViews(const std::vector<int>& bodies, const std::vector<IcpEdge>& edges)
{
  std::vector<int> largest;
  for (std::vector<int>& set : connectedSets(bodies, edges))
    if (set.size() > largest.size() &&
        std::any_of(set.begin(), set.end(), [&](int k) { return bodies[k] != bodies[set.front()]; }))
      largest = std::move(set);
  return largest;
}

}  // namespace object_modelling::multi_view_icp
