#include "session_graph.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "edge_tree.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::alignment
{
namespace
{
constexpr std::size_t TRIED_STARTS = 3;  // poses of each edge that a placement begins with

/// What the edges to the placed sessions make of a pose of one session.
struct Hypothesis
{
  Pose pose;
  std::vector<double> support;  ///< per edge
  double odds = 0;
};

std::vector<Hypothesis> hypothesesOf(const EdgeGraph& graph, int session, const std::vector<int>& edges,
                                     const Placement& placed)
{
  std::vector<Hypothesis> result;
  for (const int edge : edges)
    for (std::size_t k = 0; k < graph.candidates(edge); ++k)
    {
      const Pose& from = placed.at(graph.otherEnd(edge, session));
      const Pose pose{ graph.along(edge, k, session, from.T_reference_session), edge, graph.probability(edge, k) };
      const auto known = std::find_if(
          result.begin(), result.end(),
          [&](const Hypothesis& other)
          { return graph.between(other.pose.T_reference_session, pose.T_reference_session, session).small(); });
      if (known == result.end())
        result.push_back({ pose, {} });
      else if (pose.probability > known->pose.probability)
        known->pose = pose;
    }
  for (Hypothesis& hypothesis : result)
  {
    // Of the edges that agree, one brings the session here; the others might have agreed by chance.
    hypothesis.odds = CHANCE;
    for (const int edge : edges)
    {
      const Pose& from = placed.at(graph.otherEnd(edge, session));
      const std::optional<std::size_t> agreeing =
          graph.agreeing(edge, session, hypothesis.pose.T_reference_session, from);
      hypothesis.support.push_back(graph.support(edge, agreeing));
      hypothesis.odds *= hypothesis.support.back();
    }
  }
  return result;
}

struct Choice
{
  Pose pose;
  double probability = 0;  ///< by all edges to the placed sessions, against other poses and against none
};

/// The most probable pose of a session. Poses that every edge holds for as good make the same object.
Choice bestPose(const EdgeGraph& graph, int session, const Placement& placed)
{
  const std::vector<int> edges = graph.edgesTo(session, placed);
  const std::vector<Hypothesis> hypotheses = hypothesesOf(graph, session, edges, placed);
  if (hypotheses.empty())
    return {};
  const Hypothesis& best = *std::max_element(hypotheses.begin(), hypotheses.end(),
                                             [](const Hypothesis& x, const Hypothesis& y) { return x.odds < y.odds; });
  double sum = best.odds, none = 1;
  for (const Hypothesis& other : hypotheses)
    if (other.support != best.support)
      sum += other.odds;
  for (const int edge : edges)
    none *= graph.doubt(edge);
  return { best.pose, best.odds / (sum + none) };
}

/// Places one session after the other, the most probable first.
void complete(const EdgeGraph& graph, double min_probability, Placement* placed)
{
  while (true)
  {
    Choice best;
    int which = -1;
    for (int session = 0; session < graph.sessions(); ++session)
    {
      if (placed->count(session))
        continue;
      const Choice choice = bestPose(graph, session, *placed);
      if (choice.probability > best.probability)
      {
        best = choice;
        which = session;
      }
    }
    if (which < 0 || best.probability < min_probability)
      return;
    placed->emplace(which, best.pose);
  }
}

/// Logarithm of the odds of a placement, up to what all placements share.
double logOddsOf(const EdgeGraph& graph, const Placement& placed)
{
  double sum = (static_cast<double>(placed.size()) - 1) * std::log(CHANCE);
  for (int edge = 0; edge < graph.edges(); ++edge)
  {
    if (!graph.usable(edge))
      continue;
    sum += std::log(graph.holds(edge, placed) ? graph.support(edge, graph.agreeing(edge, placed)) : graph.doubt(edge));
  }
  return sum;
}

/// Probability that some of the sessions belong to the others as they are placed, by all edges between the two.
double jointProbability(const EdgeGraph& graph, const std::vector<int>& sessions, const Placement& placed)
{
  const auto within = [&](int session) { return std::count(sessions.begin(), sessions.end(), session) > 0; };
  double odds = CHANCE, none = 1;
  for (int edge = 0; edge < graph.edges(); ++edge)
    if (graph.usable(edge) && graph.holds(edge, placed) &&
        within(graph.ends(edge).first) != within(graph.ends(edge).second))
    {
      odds *= graph.support(edge, graph.agreeing(edge, placed));
      none *= graph.doubt(edge);
    }
  return odds / (odds + none);
}

/// Sessions that are less probable than needed where they are placed: one, or several that bear each other out but not
/// that they belong to the rest.
std::vector<int> leastProbable(const EdgeGraph& graph, double min_probability, const Placement& placed)
{
  std::vector<int> least;
  double least_probability = min_probability;
  for (const auto& [session, pose] : placed)
  {
    Placement others = placed;
    others.erase(session);
    const Choice choice = bestPose(graph, session, others);
    const bool stays = graph.between(choice.pose.T_reference_session, pose.T_reference_session, session).small();
    if ((stays ? choice.probability : 0) < least_probability)
    {
      least = { session };
      least_probability = stays ? choice.probability : 0;
    }
  }
  const std::vector<int> tree = treeOf(graph, placed);
  for (const int edge : tree)
  {
    const std::vector<int> sessions = cutOff(graph, tree, edge, placed);
    if (sessions.size() < 2)
      continue;
    const double probability = jointProbability(graph, sessions, placed);
    if (probability < least_probability)
    {
      least = sessions;
      least_probability = probability;
    }
  }
  return least;
}

/// Takes out, the least probable first, what the others do not bear out.
void settle(const EdgeGraph& graph, double min_probability, Placement* placed)
{
  while (placed->size() > 2)
  {
    const std::vector<int> least = leastProbable(graph, min_probability, *placed);
    if (least.empty())
      return;
    for (const int session : least)
      placed->erase(session);
  }
}

Placement bestPlacement(const EdgeGraph& graph, double min_probability)
{
  Placement best;
  double best_log_odds = 0;
  for (int edge = 0; edge < graph.edges(); ++edge)
    for (std::size_t k = 0; graph.usable(edge) && k < std::min(TRIED_STARTS, graph.candidates(edge)); ++k)
    {
      const auto [a, b] = graph.ends(edge);
      Placement placed = { { a, {} } };
      placed[b] = { graph.along(edge, k, b, Eigen::Isometry3d::Identity()), edge, graph.probability(edge, k) };
      complete(graph, min_probability, &placed);
      settle(graph, min_probability, &placed);
      if (placed.size() == 2 && graph.probability(edge, k) < min_probability)
        continue;
      const double log_odds = logOddsOf(graph, placed);
      if (best.empty() || log_odds > best_log_odds)
      {
        best = placed;
        best_log_odds = log_odds;
      }
    }
  return best;
}

/// Sets what became of each edge. One that agrees by another than its best pose is right by that one.
void explain(const EdgeGraph& graph, const std::vector<int>& tree, const Placement& placed,
             std::vector<AlignmentEdge>* edges)
{
  // First all is looked up: the graph reads the edges that are changed here.
  std::vector<std::optional<std::size_t>> agreeing(edges->size());
  std::vector<std::string> contradictions(edges->size());
  for (int i = 0; i < graph.edges(); ++i)
    if (graph.usable(i) && graph.holds(i, placed))
    {
      agreeing[i] = graph.agreeing(i, placed);
      contradictions[i] = graph.contradiction(i, placed).text();
    }
  for (int i = 0; i < graph.edges(); ++i)
  {
    AlignmentEdge& edge = (*edges)[i];
    edge.used = std::find(tree.begin(), tree.end(), i) != tree.end();
    if (agreeing[i])
    {
      edge.accepted = true;
      std::rotate(edge.candidates.begin(), edge.candidates.begin() + static_cast<std::ptrdiff_t>(*agreeing[i]),
                  edge.candidates.begin() + static_cast<std::ptrdiff_t>(*agreeing[i]) + 1);
    }
    if (!edge.accepted || !graph.usable(i))
      continue;
    const auto is_placed = [&](int session) { return placed.count(session) > 0; };
    const auto& [a, b] = graph.ends(i);
    if (agreeing[i] || (!is_placed(a) && !is_placed(b)))
      edge.reason.clear();
    else if (graph.holds(i, placed))
      edge.reason = "left out: contradicts the more certain alignments by " + contradictions[i];
    else
      edge.reason = "left out: other alignments contradict it, and none is certain";
  }
}
}  // namespace

std::vector<SessionPlacement> placeByEdges(const std::vector<registration::PartialModel>& parts, double min_probability,
                                           std::vector<AlignmentEdge>* edges)
{
  const EdgeGraph graph(parts, min_probability, *edges);
  const Placement found = bestPlacement(graph, min_probability);
  const std::vector<int> tree = treeOf(graph, found);
  Placement placed = placedBy(graph, tree, found);
  if (placed.empty() && graph.sessions() > 0)
    placed[0] = {};
  explain(graph, tree, placed, edges);
  std::vector<SessionPlacement> result;
  for (const auto& [session, pose] : placed)
    result.push_back({ parts[session].session_id, geometry::normalised(pose.T_reference_session) });
  return result;
}

}  // namespace object_modelling::alignment
