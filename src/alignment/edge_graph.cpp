#include "edge_graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "object_modelling/geometry/transform.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MAX_CYCLE_ROTATION_RAD = 0.09;   // 5 deg ...
constexpr double MAX_CYCLE_TRANSLATION_M = 0.01;  // ... of the object
constexpr double CERTAIN = 1e-6;                  // probability left to doubt for a pair placed by a person
constexpr double DOUBT = 3e-3;                    // left to it at least by what was found
constexpr double SURELY_SAME = 1 - 1e-9;          // above it a candidate has no share of its own
constexpr double REFUSED_RATIO = 0.9;             // of what is needed: at most, of an edge that was refused

/// Undoes what joined the poses that make the same object: p_i = own_i + q_i (p_lead - own_i), and p_lead the sum of
/// q_i own_i.
std::vector<double> ownProbabilities(const std::vector<PairCandidate>& candidates)
{
  std::vector<double> own;
  const auto lead = std::max_element(candidates.begin(), candidates.end(),
                                     [](const PairCandidate& x, const PairCandidate& y)
                                     { return x.same_object_probability < y.same_object_probability; });
  double shared = 0;
  for (auto candidate = candidates.begin(); candidate != candidates.end(); ++candidate)
  {
    const double together = lead->quality.probability, all = candidate->quality.probability;
    const double same = candidate == lead ? 0 : candidate->same_object_probability;
    own.push_back(same < SURELY_SAME ? std::clamp((all - same * together) / (1 - same), 0.0, all) : 0);
    shared += same * own.back();
  }
  if (lead != candidates.end())
    own[lead - candidates.begin()] = std::max(0.0, lead->quality.probability - shared);
  return own;
}
}  // namespace

bool PoseDifference::small() const
{
  return rotation_rad <= MAX_CYCLE_ROTATION_RAD && translation_m <= MAX_CYCLE_TRANSLATION_M;
}

std::string PoseDifference::text() const
{
  return std::to_string(std::lround(rotation_rad * 180 / M_PI)) + " deg and " +
         std::to_string(std::lround(translation_m * 1000)) + " mm";
}

EdgeGraph::EdgeGraph(const std::vector<registration::PartialModel>& parts, double min_probability,
                     const std::vector<AlignmentEdge>& edges)
    : edges_(edges), refused_probability_(REFUSED_RATIO * min_probability)
{
  std::map<std::string, int> index_of;
  for (const registration::PartialModel& part : parts)
  {
    index_of[part.session_id] = static_cast<int>(centers_.size());
    centers_.emplace_back(part.center().cast<double>());
  }
  for (const AlignmentEdge& edge : edges)
  {
    ends_.emplace_back(index_of.at(edge.session_a), index_of.at(edge.session_b));
    doubtful_.push_back(!parts[ends_.back().first].doubt.empty() || !parts[ends_.back().second].doubt.empty());
    own_.push_back(ownProbabilities(edge.candidates));
    same_sums_.push_back(std::accumulate(edge.candidates.begin(), edge.candidates.end(), 0.0,
                                         [](double sum, const PairCandidate& candidate)
                                         { return sum + candidate.same_object_probability; }));
  }
}

int EdgeGraph::otherEnd(int edge, int session) const
{
  return ends_[edge].first == session ? ends_[edge].second : ends_[edge].first;
}

bool EdgeGraph::holds(int edge, const Placement& placed) const
{
  return placed.count(ends_[edge].first) && placed.count(ends_[edge].second);
}

std::vector<int> EdgeGraph::edgesTo(int session, const Placement& placed) const
{
  std::vector<int> result;
  for (int edge = 0; edge < edges(); ++edge)
    if (usable(edge) && (ends_[edge].first == session || ends_[edge].second == session) &&
        placed.count(otherEnd(edge, session)))
      result.push_back(edge);
  return result;
}

std::size_t EdgeGraph::candidates(int edge) const
{
  const std::size_t all = edges_[edge].candidates.size();
  return edges_[edge].decision == Decision::ACCEPTED ? std::min<std::size_t>(all, 1) : all;
}

double EdgeGraph::probability(int edge, std::size_t candidate) const
{
  if (edges_[edge].decision == Decision::ACCEPTED)
    return candidate == 0 ? 1 - CERTAIN : 0;
  return capped(edge, edges_[edge].candidates[candidate].quality.probability);
}

double EdgeGraph::capped(int edge, double found) const
{
  return std::min(found, edges_[edge].accepted ? 1 - DOUBT : refused_probability_);
}

double EdgeGraph::ownProbability(int edge, std::size_t candidate) const
{
  return edges_[edge].decision == Decision::ACCEPTED ? probability(edge, candidate)
                                                     : capped(edge, own_[edge][candidate]);
}

double EdgeGraph::noneProbability(int edge) const
{
  if (edges_[edge].decision == Decision::ACCEPTED)
    return doubt(edge);
  double elsewhere = 0;
  for (std::size_t k = 1; k < candidates(edge); ++k)
    elsewhere += ownProbability(edge, k) * (1 - sameObjectProbability(edge, 0, k));
  return std::max(DOUBT, doubt(edge) - elsewhere);
}

double EdgeGraph::sameObjectProbability(int edge, std::size_t one, std::size_t other) const
{
  const std::vector<PairCandidate>& poses = edges_[edge].candidates;
  return one == other ? 1 : poses[one].same_object_probability * poses[other].same_object_probability;
}

double EdgeGraph::chance(int edge, std::size_t candidate) const
{
  const PairCandidate& pose = edges_[edge].candidates[candidate];
  if (edges_[edge].decision == Decision::ACCEPTED)
    return CHANCE;
  if (pose.kind == ProposalKind::CYCLE)
    return 1;
  return std::min(1.0, CHANCE * std::max(1.0, same_sums_[edge]));
}

double EdgeGraph::support(int edge, const std::optional<std::size_t>& agreeing) const
{
  return agreeing ? probability(edge, *agreeing) / chance(edge, *agreeing) : doubt(edge);
}

double EdgeGraph::ownSupport(int edge, const std::optional<std::size_t>& agreeing) const
{
  return agreeing ? ownProbability(edge, *agreeing) / chance(edge, *agreeing) : doubt(edge);
}

Eigen::Isometry3d EdgeGraph::along(int edge, std::size_t candidate, int to,
                                   const Eigen::Isometry3d& T_reference_from) const
{
  const Eigen::Isometry3d& T_a_b = edges_[edge].candidates[candidate].T_a_b;
  return T_reference_from * (to == ends_[edge].second ? T_a_b : T_a_b.inverse());
}

PoseDifference EdgeGraph::between(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other, int session) const
{
  return { geometry::rotationAngle_rad(one.inverse() * other),
           (one * centers_[session] - other * centers_[session]).norm() };
}

std::optional<std::size_t> EdgeGraph::agreeing(int edge, int to, const Eigen::Isometry3d& T_reference_to,
                                               const Pose& from) const
{
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < candidates(edge); ++k)
    if ((!best || support(edge, k) > support(edge, best)) &&
        between(along(edge, k, to, from.T_reference_session), T_reference_to, to).small())
      best = k;
  return best && support(edge, best) > doubt(edge) ? best : std::nullopt;
}

std::optional<std::size_t> EdgeGraph::agreeing(int edge, const Placement& placed) const
{
  const auto& [a, b] = ends_[edge];
  return agreeing(edge, b, placed.at(b).T_reference_session, placed.at(a));
}

PoseDifference EdgeGraph::contradiction(int edge, const Placement& placed) const
{
  const auto& [a, b] = ends_[edge];
  return between(along(edge, 0, b, placed.at(a).T_reference_session), placed.at(b).T_reference_session, b);
}

}  // namespace object_modelling::alignment
