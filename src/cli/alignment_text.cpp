#include <iomanip>
#include <sstream>

#include "object_modelling/registration/pair_figures.h"
#include "report_text.h"

namespace object_modelling::cli
{
namespace
{
constexpr std::size_t REPORTED_CANDIDATES = 3;

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
    for (std::size_t i = 0; i < std::min(edge.candidates.size(), REPORTED_CANDIDATES); ++i)
      candidates.push_back(toJson(edge.candidates[i]));
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

std::string toText(const alignment::AlignmentResult& result)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(2);
  for (const alignment::AlignmentEdge& edge : result.edges)
  {
    out << "pair      " << edge.session_a << " and " << edge.session_b << ": "
        << (edge.accepted ? edge.used ? "accepted" : "accepted, not used" : "refused")
        << (edge.decision == alignment::Decision::AUTOMATIC ? "" : " by a person");
    if (const alignment::PairCandidate* best = edge.best())
      out << " (probability " << best->quality.probability << ", overlap " << best->quality.overlap_ratio
          << ", free-space violation " << best->quality.fsv_ratio << ", surfaces " << 1000 * best->quality.rmse_m
          << " mm apart, colours " << best->quality.color_agreement << ")";
    out << (edge.reason.empty() ? "" : "\n          " + edge.reason) << "\n";
  }
  for (const alignment::SessionPlacement& placed : result.placements)
    out << "placed    " << placed.session_id << "\n";
  for (const std::string& id : result.left_out)
    out << "left out  " << id << "\n";
  return out.str();
}

}  // namespace object_modelling::cli
