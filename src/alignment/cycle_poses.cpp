#include "cycle_poses.h"

#include <algorithm>

namespace object_modelling::alignment
{
namespace
{
constexpr std::size_t MOST_POSES = 8;       // of one edge: as many sessions between its ends
constexpr double LEAST_PROBABILITY = 0.25;  // of both poses being right, to be worth the time

struct Implied
{
  Eigen::Isometry3d T_a_b;
  double probability;  ///< of both poses that imply it
};

/// By way of one session.
std::optional<Implied> impliedBy(const EdgeGraph& graph, int edge, int between)
{
  const auto& [a, b] = graph.ends(edge);
  std::optional<int> first, second;
  for (int other = 0; other < graph.edges(); ++other)
  {
    const auto& [x, y] = graph.ends(other);
    if (!graph.usable(other) || (x != between && y != between))
      continue;
    const int end = graph.otherEnd(other, between);
    if (end == a)
      first = other;
    else if (end == b)
      second = other;
  }
  if (!first || !second)
    return std::nullopt;
  const Eigen::Isometry3d T_a_between = graph.along(*first, 0, between, Eigen::Isometry3d::Identity());
  return Implied{ graph.along(*second, 0, b, T_a_between),
                  graph.probability(*first, 0) * graph.probability(*second, 0) };
}

bool held(const EdgeGraph& graph, int edge, const Eigen::Isometry3d& T_a_b)
{
  const int b = graph.ends(edge).second;
  for (std::size_t k = 0; k < graph.candidates(edge); ++k)
    if (graph.between(graph.along(edge, k, b, Eigen::Isometry3d::Identity()), T_a_b, b).small())
      return true;
  return false;
}
}  // namespace

std::vector<std::vector<Eigen::Isometry3d>> cyclePoses(const EdgeGraph& graph)
{
  std::vector<std::vector<Eigen::Isometry3d>> result(graph.edges());
  for (int edge = 0; edge < graph.edges(); ++edge)
  {
    if (graph.decided(edge) || !graph.usable(edge))
      continue;
    const auto& [a, b] = graph.ends(edge);
    std::vector<Implied> poses;
    for (int session = 0; session < graph.sessions(); ++session)
      if (session != a && session != b)
        if (const std::optional<Implied> implied = impliedBy(graph, edge, session);
            implied && implied->probability >= LEAST_PROBABILITY && !held(graph, edge, implied->T_a_b))
          poses.push_back(*implied);
    std::stable_sort(poses.begin(), poses.end(),
                     [](const Implied& x, const Implied& y) { return x.probability > y.probability; });
    for (std::size_t i = 0; i < std::min(MOST_POSES, poses.size()); ++i)
      result[edge].push_back(poses[i].T_a_b);
  }
  return result;
}

}  // namespace object_modelling::alignment
