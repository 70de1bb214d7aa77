#include "object_modelling/alignment/session_alignment.h"

#include <algorithm>
#include <memory>

#include "object_modelling/base/options.h"
#include "object_modelling/base/status.h"
#include "session_graph.h"
#include "surface_pair.h"

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
  Parts(const std::vector<PartialModel>& models, int threads)
      : models_(models), threads_(threads), prepared_(models.size())
  {
  }
  const Part& at(std::size_t index)
  {
    if (!prepared_[index])
      prepared_[index] = std::make_unique<Part>(models_[index], threads_);
    return *prepared_[index];
  }

private:
  const std::vector<PartialModel>& models_;
  int threads_;
  std::vector<std::unique_ptr<Part>> prepared_;
};
}  // namespace

AlignmentResult alignSessions(const std::vector<PartialModel>& parts, const std::vector<AlignmentEdge>& known_edges,
                              const PairAlignmentOptions& options, base::JobControl& control)
{
  base::checked(options);
  AlignmentResult result;
  if (parts.empty())
  {
    result.status = { base::StatusCode::INVALID_ARGUMENT, "no sessions to align; name at least one" };
    return result;
  }
  std::vector<std::string> ids;
  for (const PartialModel& part : parts)
  {
    if (std::find(ids.begin(), ids.end(), part.session_id) != ids.end())
    {
      result.status = { base::StatusCode::INVALID_ARGUMENT,
                        "session '" + part.session_id + "' is named twice; name each once" };
      return result;
    }
    ids.push_back(part.session_id);
  }
  const std::size_t pairs = parts.size() * (parts.size() - 1) / 2;
  control.report("align", 0, std::max<std::size_t>(1, pairs));
  Parts prepared(parts, options.threads);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j)
    {
      if (const AlignmentEdge* known = find(known_edges, ids[i], ids[j]))
        result.edges.push_back(*known);
      else
      {
        const PairAlignment found = alignParts(prepared.at(i), prepared.at(j), options, control);
        result.edges.push_back({ ids[i], ids[j], found.accepted, false, found.reason, found.candidates });
      }
      control.report("align", result.edges.size(), pairs);
    }
  result.placements = placeByEdges(parts, &result.edges);
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
  control.report("align", std::max<std::size_t>(1, pairs), std::max<std::size_t>(1, pairs));
  return result;
}

}  // namespace object_modelling::alignment
