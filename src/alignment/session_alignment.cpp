#include "object_modelling/alignment/session_alignment.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "cycle_poses.h"
#include "object_modelling/base/options.h"
#include "object_modelling/base/status.h"
#include "part_alignment.h"
#include "session_graph.h"

namespace object_modelling::alignment
{
namespace
{
std::string joined(const std::vector<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

std::vector<std::string> idsOf(const std::vector<registration::PartialModel>& parts)
{
  std::vector<std::string> ids;
  for (const registration::PartialModel& part : parts)
    ids.push_back(part.session_id);
  return ids;
}

base::Status checked(const std::vector<registration::PartialModel>& parts)
{
  if (parts.empty())
    return { base::StatusCode::INVALID_ARGUMENT, "no sessions to align; name at least one" };
  std::vector<std::string> ids = idsOf(parts);
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    return { base::StatusCode::INVALID_ARGUMENT, "session '" + *twice + "' is named twice; name each once" };
  return {};
}

std::string reasonsOf(const AlignmentResult& result)
{
  std::string text;
  for (const AlignmentEdge& edge : result.edges)
  {
    const auto out = [&](const std::string& id)
    { return std::find(result.left_out.begin(), result.left_out.end(), id) != result.left_out.end(); };
    if (!edge.reason.empty() && (result.placements.empty() || out(edge.session_a) || out(edge.session_b)))
      text += "; " + edge.session_a + " and " + edge.session_b + ": " + edge.reason;
  }
  return text;
}

const AlignmentEdge* find(const std::vector<AlignmentEdge>& known_edges, const std::string& a, const std::string& b)
{
  for (const AlignmentEdge& known : known_edges)
    if ((known.session_a == a && known.session_b == b) || (known.session_a == b && known.session_b == a))
      return &known;
  return nullptr;
}

/// Parts, each prepared when a pair needs it for the first time.
class Parts
{
public:
  Parts(const std::vector<registration::PartialModel>& models, int threads)
      : models_(models), threads_(threads), prepared_(models.size())
  {
  }
  const registration::MatchedSurface& at(std::size_t index)
  {
    if (!prepared_[index])
      prepared_[index] = std::make_unique<registration::MatchedSurface>(models_[index], threads_);
    return *prepared_[index];
  }

private:
  const std::vector<registration::PartialModel>& models_;
  int threads_;
  std::vector<std::unique_ptr<registration::MatchedSurface>> prepared_;
};

void take(const PairAlignment& pair, AlignmentEdge* edge)
{
  edge->accepted = pair.accepted;
  edge->reason = pair.reason;
  edge->candidates = pair.candidates;
}

/// The pair in the order in which it is known, from there if that still holds.
AlignmentEdge found(const AlignmentEdge* known, Parts& parts, const std::vector<std::string>& ids, std::size_t i,
                    std::size_t j, const PairAlignmentOptions& options, base::JobControl& control)
{
  if (known && known->session_a != ids[i])
    std::swap(i, j);
  std::optional<PairAlignment> pair;
  if (known && known->accepted)
    pair = confirmParts(parts.at(i), parts.at(j), known->candidates, options, control);
  if (!pair)
    pair = alignParts(parts.at(i), parts.at(j), options, control);
  AlignmentEdge edge;
  edge.session_a = ids[i];
  edge.session_b = ids[j];
  take(*pair, &edge);
  return edge;
}

/// Where a session would be left out, lets each pair judge the poses that others imply for it: of a symmetric object
/// each pair may have found another of many right poses.
void closeCycles(const std::vector<registration::PartialModel>& parts, const PairAlignmentOptions& options,
                 Parts& prepared, base::JobControl& control, std::vector<AlignmentEdge>* edges)
{
  std::vector<AlignmentEdge> tried = *edges;
  if (parts.size() < 3 || placeByEdges(parts, options.min_probability, &tried).size() == parts.size())
    return;
  const EdgeGraph graph(parts, options.min_probability, *edges);
  const std::vector<std::vector<Eigen::Isometry3d>> implied = cyclePoses(graph);
  for (int i = 0; i < graph.edges(); ++i)
    if (!implied[i].empty())
    {
      const auto& [a, b] = graph.ends(i);
      AlignmentEdge& edge = (*edges)[i];
      take(alsoAt(prepared.at(a), prepared.at(b), edge.candidates, implied[i], options, control), &edge);
    }
}
}  // namespace

std::string nameOf(Decision decision)
{
  switch (decision)
  {
    case Decision::ACCEPTED:
      return "accepted";
    case Decision::REFUSED:
      return "refused";
    case Decision::AUTOMATIC:
      break;
  }
  return "automatic";
}

AlignmentResult placeSessions(const std::vector<registration::PartialModel>& parts, double min_probability,
                              std::vector<AlignmentEdge> edges)
{
  AlignmentResult result;
  const std::vector<std::string> ids = idsOf(parts);
  result.edges = std::move(edges);
  result.placements = placeByEdges(parts, min_probability, &result.edges);
  for (const std::string& id : ids)
    if (std::none_of(result.placements.begin(), result.placements.end(),
                     [&](const SessionPlacement& placed) { return placed.session_id == id; }))
      result.left_out.push_back(id);
  if (parts.size() > 1 && result.placements.size() < 2)
  {
    result.placements.clear();
    result.left_out = ids;
    result.status = { base::StatusCode::NO_RESULT,
                      "sessions " + joined(ids) + " could not be aligned" + reasonsOf(result) };
  }
  else if (!result.left_out.empty())
    result.status = { base::StatusCode::OK, "left out, since they connect to none of the others: sessions " +
                                                joined(result.left_out) + reasonsOf(result) };
  return result;
}

AlignmentResult alignSessions(const std::vector<registration::PartialModel>& parts,
                              const std::vector<AlignmentEdge>& known_edges, const PairAlignmentOptions& options,
                              base::JobControl& control)
{
  base::checked(options);
  AlignmentResult refused;
  refused.status = checked(parts);
  if (!refused.status.ok())
    return refused;
  const std::vector<std::string> ids = idsOf(parts);
  const std::size_t pairs = std::max<std::size_t>(1, parts.size() * (parts.size() - 1) / 2);
  control.report("align", 0, pairs);
  Parts prepared(parts, options.threads);
  std::vector<AlignmentEdge> edges;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j)
    {
      const AlignmentEdge* known = find(known_edges, ids[i], ids[j]);
      if (known && known->decision != Decision::AUTOMATIC)
        edges.push_back(*known);
      else
        edges.push_back(found(known, prepared, ids, i, j, options, control));
      control.report("align", edges.size(), pairs);
    }
  control.report("align", pairs, pairs);
  closeCycles(parts, options, prepared, control, &edges);
  return placeSessions(parts, options.min_probability, std::move(edges));
}

}  // namespace object_modelling::alignment
