#include "object_modelling/registration/pair_figures.h"
#include "report_text.h"

namespace object_modelling::cli
{
namespace
{
nlohmann::json toJson(const Eigen::Isometry3d& T)
{
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({ T.matrix()(row, 0), T.matrix()(row, 1), T.matrix()(row, 2), T.matrix()(row, 3) });
  return rows;
}

nlohmann::json toJson(const alignment::PairCandidate& candidate)
{
  nlohmann::json json = { { "kind", alignment::nameOf(candidate.kind) }, { "T_a_b", toJson(candidate.T_a_b) } };
  for (const registration::PairFigure& figure : registration::pairFigures())
    json[figure.name] = candidate.quality.*figure.value;
  json["same_object_probability"] = candidate.same_object_probability;
  return json;
}
}  // namespace

nlohmann::json toJson(const alignment::AlignmentResult& result)
{
  nlohmann::json json = { { "status", toJson(result.status) }, { "left_out", result.left_out } };
  // In the form that the evaluation kit scores.
  json["reference"] = result.placements.empty() ? "" : result.placements.front().session_id;
  json["transforms"] = nlohmann::json::object();
  for (std::size_t i = 1; i < result.placements.size(); ++i)
    json["transforms"][result.placements[i].session_id] = toJson(result.placements[i].T_reference_session);
  json["edges"] = nlohmann::json::array();
  for (const alignment::AlignmentEdge& edge : result.edges)
  {
    nlohmann::json candidates = nlohmann::json::array();
    for (const alignment::PairCandidate& candidate : edge.candidates)
      candidates.push_back(toJson(candidate));
    json["edges"].push_back({ { "session_a", edge.session_a },
                              { "session_b", edge.session_b },
                              { "decision", alignment::nameOf(edge.decision) },
                              { "accepted", edge.accepted },
                              { "used", edge.used },
                              { "reason", edge.reason },
                              { "candidates", candidates } });
  }
  return json;
}

}  // namespace object_modelling::cli
