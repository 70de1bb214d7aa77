#include "alignment_report.h"
#include "object_modelling/alignment/pair_evidence.h"
#include "object_modelling/registration/pair_figures.h"

namespace object_modelling::benchmark_alignment
{
namespace
{
nlohmann::json toJson(const Counts& counts)
{
  return {
    { "pairs", counts.pairs }, { "right", counts.right }, { "wrong", counts.wrong }, { "refused", counts.refused }
  };
}

nlohmann::json candidateJson(const alignment::PairCandidate& candidate, const CandidateErrors* errors)
{
  const registration::PairQuality& quality = candidate.quality;
  nlohmann::json features;
  const alignment::FeatureVector values = alignment::featuresOf(quality);
  for (std::size_t i = 0; i < values.size(); ++i)
    features[alignment::nameOf(static_cast<alignment::Feature>(i))] = values[i];
  nlohmann::json json = { { "kind", alignment::nameOf(candidate.kind) },
                          { "a_from_b", rowsOf(candidate.T_a_b) },
                          { "features", features },
                          { "rotation_error_deg", nullptr },
                          { "translation_error_mm", nullptr },
                          { "mesh_distance_mm", nullptr } };
  for (const registration::PairFigure& figure : registration::pairFigures())
    json[figure.name] = quality.*figure.value;
  if (errors)
  {
    json["rotation_error_deg"] = errors->rotation_deg;
    json["translation_error_mm"] = errors->translation_mm;
    json["mesh_distance_mm"] = errors->mesh_distance_mm;
  }
  return json;
}

nlohmann::json toJson(const alignment::DifferenceFeatures& features)
{
  nlohmann::json json;
  for (std::size_t i = 0; i < features.size(); ++i)
    json[alignment::nameOf(static_cast<alignment::DifferenceFeature>(i))] = features[i];
  return json;
}

nlohmann::json toJson(const PairRow& pair)
{
  nlohmann::json json = { { "a", pair.a },
                          { "b", pair.b },
                          { "same_object", pair.same_object },
                          { "true_overlap_ratio", nullptr },
                          { "true_turn_rad", nullptr },
                          { "true_a_from_b", nullptr },
                          { "accepted", pair.result.accepted },
                          { "right", pair.result.accepted && pair.firstIsRight() },
                          { "reason", pair.result.reason },
                          { "seconds", pair.seconds },
                          { "rank_of_right", nullptr },
                          { "candidates", nlohmann::json::array() } };
  if (pair.same_object)
  {
    json["true_overlap_ratio"] = pair.true_overlap;
    json["true_turn_rad"] = pair.true_turn_rad;
    json["true_a_from_b"] = rowsOf(pair.T_a_b_true);
  }
  if (const std::optional<int> rank = pair.rankOfRight())
    json["rank_of_right"] = *rank;
  for (std::size_t i = 0; i < pair.result.candidates.size(); ++i)
  {
    json["candidates"].push_back(
        candidateJson(pair.result.candidates[i], pair.same_object ? &pair.errors[i] : nullptr));
    json["candidates"].back()["right"] = static_cast<bool>(pair.right[i]);
    json["candidates"].back()["log_odds"] =
        alignment::logOdds(pair.result.candidates[i].quality, pair.same_pose_probability);
    if (i < pair.differences.size() && pair.differences[i])
      json["candidates"].back()["difference"] = toJson(*pair.differences[i]);
  }
  if (pair.from_truth)
    json["from_truth"] = candidateJson(*pair.from_truth, &pair.from_truth_errors);
  return json;
}
}  // namespace

nlohmann::json rowsOf(const Eigen::Isometry3d& T)
{
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({ T(row, 0), T(row, 1), T(row, 2), T(row, 3) });
  return rows;
}

nlohmann::json toJson(const std::vector<SessionRow>& sessions, const std::vector<PairRow>& pairs)
{
  const Summary summary = summaryOf(pairs);
  nlohmann::json json = { { "sessions", nlohmann::json::array() },
                          { "pairs", nlohmann::json::array() },
                          { "summary",
                            { { "enough_overlap_ratio", ENOUGH_OVERLAP_RATIO },
                              { "enough_overlap", toJson(summary.enough) },
                              { "little_overlap", toJson(summary.little) },
                              { "cross", toJson(summary.cross) },
                              { "median_s", summary.median_s },
                              { "max_s", summary.max_s } } } };
  for (const SessionRow& session : sessions)
    json["sessions"].push_back({ { "id", session.id },
                                 { "folder", session.folder },
                                 { "problem", session.problem },
                                 { "object", session.truth.object },
                                 { "mesh", session.truth.mesh },
                                 { "keyframes", session.keyframes },
                                 { "points", session.part.points.size() },
                                 { "spacing_m", session.part.spacing_m },
                                 { "part_s", session.part_s },
                                 { "session_from_object", rowsOf(session.truth.T_session_object) },
                                 { "camera_rmse_mm", session.truth.camera_rmse_mm },
                                 { "mesh_distance_mm", session.mesh_distance_mm } });
  for (const PairRow& pair : pairs)
    json["pairs"].push_back(toJson(pair));
  return json;
}

}  // namespace object_modelling::benchmark_alignment
