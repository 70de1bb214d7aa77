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
  std::vector<std::optional<std::size_t>> agreeing;  ///< per edge
  double odds = 0;
  double own_odds = 0;  ///< without the poses that make the same object
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
    hypothesis.odds = hypothesis.own_odds = 1;
    double bringing = 1;
    for (const int edge : edges)
    {
      const Pose& from = placed.at(graph.otherEnd(edge, session));
      hypothesis.agreeing.push_back(graph.agreeing(edge, session, hypothesis.pose.T_reference_session, from));
      hypothesis.odds *= graph.support(edge, hypothesis.agreeing.back());
      hypothesis.own_odds *= graph.ownSupport(edge, hypothesis.agreeing.back());
      if (hypothesis.agreeing.back())
        bringing = std::min(bringing, graph.chance(edge, *hypothesis.agreeing.back()));
    }
    hypothesis.odds *= bringing;
    hypothesis.own_odds *= bringing;
  }
  return result;
}

struct Choice
{
  Pose pose;
  double probability = 0;  ///< by all edges to the placed sessions, against other poses and against none
};

/// Probability that two poses make the same object: by the edges that contain both, the lowest of theirs.
double sameObjectProbability(const EdgeGraph& graph, const std::vector<int>& edges, const Hypothesis& one,
                             const Hypothesis& other)
{
  std::optional<double> least;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (one.agreeing[i] && other.agreeing[i])
    {
      const double same = graph.sameObjectProbability(edges[i], *one.agreeing[i], *other.agreeing[i]);
      least = std::min(least.value_or(1), same);
    }
  return least.value_or(0);
}

/// The most probable pose of a session, of those that are `where` it is if that is given. Another pose is a rival by
/// how probably it makes another object; those that make the same one are in the odds already.
Choice bestPose(const EdgeGraph& graph, int session, const Placement& placed,
                const std::optional<Eigen::Isometry3d>& where = std::nullopt)
{
  const std::vector<int> edges = graph.edgesTo(session, placed);
  const std::vector<Hypothesis> hypotheses = hypothesesOf(graph, session, edges, placed);
  const Hypothesis* best = nullptr;
  for (const Hypothesis& hypothesis : hypotheses)
    if ((!best || hypothesis.odds > best->odds) &&
        (!where || graph.between(hypothesis.pose.T_reference_session, *where, session).small()))
      best = &hypothesis;
  if (!best)
    return {};
  double sum = best->odds, none = 1;
  for (const Hypothesis& other : hypotheses)
    if (&other != best)
      sum += (1 - sameObjectProbability(graph, edges, *best, other)) * other.own_odds;
  for (const int edge : edges)
    none *= graph.noneProbability(edge);
  return { best->pose, best->odds / (sum + none) };
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
  const std::vector<int> tree = rarestTreeOf(graph, placed);
  double sum = (static_cast<double>(placed.size() - tree.size()) - 1) * std::log(CHANCE);
  for (const int edge : tree)
    sum += std::log(graph.chance(edge, *graph.agreeing(edge, placed)));
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
  double odds = 1, none = 1, bringing = 1;
  for (int edge = 0; edge < graph.edges(); ++edge)
    if (graph.usable(edge) && graph.holds(edge, placed) &&
        within(graph.ends(edge).first) != within(graph.ends(edge).second))
    {
      const std::optional<std::size_t> agreeing = graph.agreeing(edge, placed);
      odds *= graph.support(edge, agreeing);
      none *= graph.doubt(edge);
      if (agreeing)
        bringing = std::min(bringing, graph.chance(edge, *agreeing));
    }
  odds *= bringing;
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
    const double probability = bestPose(graph, session, others, pose.T_reference_session).probability;
    if (probability < least_probability)
    {
      least = { session };
      least_probability = probability;
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
    result.push_back({ parts[session].session_id, geometry::normalized(pose.T_reference_session) });
  return result;
}

}  // namespace object_modelling::alignment
