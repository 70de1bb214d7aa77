#include "alignment_together.h"

#include <chrono>
#include <iomanip>
#include <map>
#include <sstream>

namespace object_modelling::benchmark_alignment
{
namespace
{
nlohmann::json placementsOf(const alignment::AlignmentResult& result)
{
  nlohmann::json json = nlohmann::json::object();
  for (const alignment::SessionPlacement& placed : result.placements)
    json[placed.session_id] = rowsOf(placed.T_reference_session);
  return json;
}

nlohmann::json toJson(const alignment::AlignmentEdge& edge)
{
  nlohmann::json json = {
    { "a", edge.session_a }, { "b", edge.session_b },   { "accepted", edge.accepted },
    { "used", edge.used },   { "reason", edge.reason }, { "candidates", nlohmann::json::array() }
  };
  for (const alignment::PairCandidate& candidate : edge.candidates)
    json["candidates"].push_back({ { "kind", alignment::nameOf(candidate.kind) },
                                   { "a_from_b", rowsOf(candidate.T_a_b) },
                                   { "probability", candidate.quality.probability } });
  return json;
}
}  // namespace

std::vector<ObjectRow> alignTogether(const std::vector<SessionRow>& sessions, std::size_t min_sessions,
                                     const alignment::PairAlignmentOptions& options)
{
  std::vector<ObjectRow> rows;
  std::map<std::string, std::vector<registration::PartialModel>> parts;
  for (const SessionRow& session : sessions)
    if (session.problem.empty())
    {
      std::vector<registration::PartialModel>& of_object = parts[session.truth.object];
      if (of_object.empty())
        rows.push_back({ session.truth.object, {}, {}, 0 });
      of_object.push_back(session.part);
    }
  std::vector<ObjectRow> result;
  for (ObjectRow& row : rows)
  {
    const std::vector<registration::PartialModel>& of_object = parts[row.object];
    if (of_object.size() < min_sessions)
      continue;
    for (const registration::PartialModel& part : of_object)
      row.sessions.push_back(part.session_id);
    base::JobControl control;
    const auto start = std::chrono::steady_clock::now();
    row.result = alignment::alignSessions(of_object, {}, options, control);
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.push_back(row);
  }
  return result;
}

std::string toTable(const std::vector<ObjectRow>& rows)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << "| object | sessions | placed | s | message |\n|"
      << " --- | --- | --- | --- | --- |\n";
  for (const ObjectRow& row : rows)
    out << "| " << row.object << " | " << row.sessions.size() << " | " << row.result.placements.size() << " | "
        << row.seconds << " | " << row.result.status.message << " |\n";
  return out.str();
}

nlohmann::json toJson(const std::vector<ObjectRow>& rows)
{
  nlohmann::json json = nlohmann::json::array();
  for (const ObjectRow& row : rows)
  {
    nlohmann::json edges = nlohmann::json::array();
    for (const alignment::AlignmentEdge& edge : row.result.edges)
      edges.push_back(toJson(edge));
    json.push_back({ { "object", row.object },
                     { "sessions", row.sessions },
                     { "reference_from_session", placementsOf(row.result) },
                     { "left_out", row.result.left_out },
                     { "edges", edges },
                     { "seconds", row.seconds } });
  }
  return json;
}

}  // namespace object_modelling::benchmark_alignment
