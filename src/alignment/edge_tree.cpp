#include "edge_tree.h"

#include <algorithm>
#include <set>

namespace object_modelling::alignment
{
namespace
{
/// Of the edges that agree, those with the largest values.
template <typename Value>
std::vector<int> spanningTree(const EdgeGraph& graph, const Placement& placed, const Value& value)
{
  std::vector<int> order, tree;
  for (int edge = 0; edge < graph.edges(); ++edge)
    if (graph.usable(edge) && graph.holds(edge, placed) && graph.agreeing(edge, placed))
      order.push_back(edge);
  std::stable_sort(order.begin(), order.end(),
                   [&](int x, int y)
                   { return value(x, *graph.agreeing(x, placed)) > value(y, *graph.agreeing(y, placed)); });
  std::map<int, int> component;
  for (const auto& [session, pose] : placed)
    component[session] = session;
  for (const int edge : order)
  {
    const int from = component[graph.ends(edge).first], to = component[graph.ends(edge).second];
    if (from == to)
      continue;
    tree.push_back(edge);
    for (auto& [session, of] : component)
      if (of == from)
        of = to;
  }
  return tree;
}
}  // namespace

std::vector<int> treeOf(const EdgeGraph& graph, const Placement& placed)
{
  return spanningTree(graph, placed, [&](int edge, std::size_t agreeing) { return graph.probability(edge, agreeing); });
}

std::vector<int> rarestTreeOf(const EdgeGraph& graph, const Placement& placed)
{
  return spanningTree(graph, placed, [&](int edge, std::size_t agreeing) { return -graph.chance(edge, agreeing); });
}

std::vector<int> cutOff(const EdgeGraph& graph, const std::vector<int>& tree, int cut, const Placement& placed)
{
  std::set<int> side = { graph.ends(cut).first };
  for (bool grows = true; grows;)
  {
    grows = false;
    for (const int edge : tree)
    {
      const auto& [a, b] = graph.ends(edge);
      if (edge != cut && side.count(a) != side.count(b))
        grows = side.insert(a).second || side.insert(b).second;
    }
  }
  const bool other =
      2 * side.size() > placed.size() || (2 * side.size() == placed.size() && side.count(placed.begin()->first));
  std::vector<int> result;
  for (const auto& [session, pose] : placed)
    if ((side.count(session) > 0) != other)
      result.push_back(session);
  return result;
}

Placement placedBy(const EdgeGraph& graph, const std::vector<int>& tree, const Placement& near)
{
  Placement placed;
  if (near.empty())
    return placed;
  placed[near.begin()->first] = {};
  for (bool grows = true; grows;)
  {
    grows = false;
    for (const int edge : tree)
    {
      const auto& [a, b] = graph.ends(edge);
      if (placed.count(a) == placed.count(b))
        continue;
      const int to = placed.count(a) ? b : a;
      const std::size_t candidate = *graph.agreeing(edge, near);
      placed[to] = { graph.along(edge, candidate, to, placed.at(graph.otherEnd(edge, to)).T_reference_session), edge,
                     graph.probability(edge, candidate) };
      grows = true;
    }
  }
  return placed;
}

}  // namespace object_modelling::alignment
