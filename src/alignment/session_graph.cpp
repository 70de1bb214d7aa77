#include "session_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "object_modelling/geometry/transform.h"
#include "pair_decision.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MAX_CYCLE_ROTATION_RAD = 0.09;   // 5 deg ...
constexpr double MAX_CYCLE_TRANSLATION_M = 0.01;  // ... of the object
constexpr double CERTAIN_PROBABILITY = 0.95;      // tree edges above it stand against one edge that contradicts them

struct Link
{
  int edge, to;
  Eigen::Isometry3d T_from_to;
};

using Graph = std::vector<std::vector<Link>>;

/// A way through the tree: what is at its end in the frame of its start, and the least certain edge on it.
struct Path
{
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  int weakest_edge = -1;
};

class Tree
{
public:
  Tree(int count, const std::vector<AlignmentEdge>& edges) : edges_(edges), graph_(count) {}

  void add(int edge, int a, int b)
  {
    const Eigen::Isometry3d& T_a_b = edges_[edge].best()->T_a_b;
    graph_[a].push_back({ edge, b, T_a_b });
    graph_[b].push_back({ edge, a, T_a_b.inverse() });
  }
  void remove(int edge)
  {
    for (std::vector<Link>& links : graph_)
      links.erase(std::remove_if(links.begin(), links.end(), [edge](const Link& link) { return link.edge == edge; }),
                  links.end());
  }
  std::optional<Path> path(int from, int to, int came_from = -1) const
  {
    if (from == to)
      return Path{};
    for (const Link& link : graph_[from])
    {
      if (link.to == came_from)
        continue;
      std::optional<Path> rest = path(link.to, to, from);
      if (!rest)
        continue;
      rest->T_from_to = link.T_from_to * rest->T_from_to;
      if (rest->weakest_edge < 0 || probability(link.edge) < probability(rest->weakest_edge))
        rest->weakest_edge = link.edge;
      return rest;
    }
    return std::nullopt;
  }
  /// A person's word is certain.
  double probability(int edge) const
  {
    return edges_[edge].decision == Decision::ACCEPTED ? 1.0 : edges_[edge].best()->quality.probability;
  }

private:
  const std::vector<AlignmentEdge>& edges_;
  Graph graph_;
};

/// By how much two poses of one part differ.
struct Off
{
  double rotation_rad = 0, translation_m = 0;  ///< translation: of the part's centre

  bool small() const { return rotation_rad <= MAX_CYCLE_ROTATION_RAD && translation_m <= MAX_CYCLE_TRANSLATION_M; }
  std::string text() const
  {
    return std::to_string(std::lround(rotation_rad * 180 / M_PI)) + " deg and " +
           std::to_string(std::lround(translation_m * 1000)) + " mm";
  }
};

Off offBetween(const Eigen::Isometry3d& T_a_b, const Eigen::Isometry3d& other, const PartialModel& b)
{
  const Eigen::Vector3d centre = b.centre().cast<double>();
  return { geometry::rotationAngle_rad(T_a_b.inverse() * other), (T_a_b * centre - other * centre).norm() };
}

/// Whether one of the poses that the edge holds for as good as its best is the one given.
bool agrees(const AlignmentEdge& edge, const Eigen::Isometry3d& T_a_b, const PartialModel& b)
{
  return std::any_of(
      edge.candidates.begin(), edge.candidates.end(),
      [&](const PairCandidate& candidate)
      { return scoreAlike(edge.best()->quality, candidate.quality) && offBetween(T_a_b, candidate.T_a_b, b).small(); });
}
}  // namespace

std::vector<SessionPlacement> placeByEdges(const std::vector<PartialModel>& parts, std::vector<AlignmentEdge>* edges)
{
  const auto count = static_cast<int>(parts.size());
  std::map<std::string, int> index_of;
  for (int i = 0; i < count; ++i)
    index_of[parts[i].session_id] = i;
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(edges->size()); ++i)
  {
    (*edges)[i].used = false;
    if ((*edges)[i].accepted && (*edges)[i].best())
      order.push_back(i);
  }
  Tree tree(count, *edges);
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return tree.probability(x) > tree.probability(y); });
  for (const int i : order)
  {
    AlignmentEdge& edge = (*edges)[i];
    edge.reason.clear();  // of an earlier placement
    const int a = index_of.at(edge.session_a), b = index_of.at(edge.session_b);
    const std::optional<Path> path = tree.path(a, b);
    if (!path)
    {
      tree.add(i, a, b);
      edge.used = true;
      continue;
    }
    if (agrees(edge, path->T_from_to, parts[b]))
      continue;
    const Off off = offBetween(path->T_from_to, edge.best()->T_a_b, parts[b]);
    edge.reason = "left out: contradicts the more certain alignments by " + off.text();
    AlignmentEdge& weakest = (*edges)[path->weakest_edge];
    if (tree.probability(path->weakest_edge) < CERTAIN_PROBABILITY)
    {
      weakest.used = false;
      weakest.reason = "left out: the cycle through sessions '" + edge.session_a + "' and '" + edge.session_b +
                       "' does not close, by " + off.text();
      tree.remove(path->weakest_edge);
    }
  }

  std::vector<SessionPlacement> largest;
  for (int reference = 0; reference < count; ++reference)
  {
    std::vector<SessionPlacement> placed = { { parts[reference].session_id, Eigen::Isometry3d::Identity() } };
    for (int i = 0; i < count; ++i)
      if (const std::optional<Path> path = i == reference ? std::nullopt : tree.path(reference, i))
        placed.push_back({ parts[i].session_id, geometry::normalised(path->T_from_to) });
    if (placed.size() > largest.size())
      largest = placed;
  }
  return largest;
}

}  // namespace object_modelling::alignment
