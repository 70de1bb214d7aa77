#include "report_text.h"

namespace object_modelling::cli
{
nlohmann::json toJson(const multi_view_icp::MultiViewIcpResult& result, const std::vector<int>& keyframe_ids)
{
  nlohmann::json keyframes = nlohmann::json::array(), pairs = keyframes, free = keyframes, left_out = keyframes;
  for (std::size_t k = 0; k < result.residuals.size(); ++k)
    keyframes.push_back({ { "keyframe_id", keyframe_ids.at(k) },
                          { "point_count", result.residuals[k].point_count },
                          { "rmse_before_m", result.residuals[k].rmse_before_m },
                          { "rmse_after_m", result.residuals[k].rmse_after_m },
                          { "inlier_ratio", result.residuals[k].inlier_ratio } });
  for (const multi_view_icp::IcpPair& pair : result.pairs)
    pairs.push_back({ { "keyframe_a", keyframe_ids.at(pair.view_a) },
                      { "keyframe_b", keyframe_ids.at(pair.view_b) },
                      { "overlap_ratio", pair.overlap_ratio },
                      { "point_count", pair.point_count },
                      { "rmse_before_m", pair.rmse_before_m },
                      { "rmse_after_m", pair.rmse_after_m } });
  for (const multi_view_icp::FreeDirection& direction : result.free_directions)
    free.push_back({ { "keyframe_id", keyframe_ids.at(direction.view) },
                     { "kind", direction.rotation ? "rotation" : "translation" },
                     { "axis", { direction.axis_world.x(), direction.axis_world.y(), direction.axis_world.z() } } });
  for (const int view : result.left_out)
    left_out.push_back(keyframe_ids.at(view));
  return { { "status", toJson(result.status) },
           { "converged", result.converged },
           { "iterations", result.iterations },
           { "rmse_m", result.rmse_m },
           { "left_out", left_out },
           { "keyframes", keyframes },
           { "pairs", pairs },
           { "free_directions", free } };
}

nlohmann::json toJson(const pipeline::SessionRefinement& refined)
{
  nlohmann::json json = { { "status", toJson(refined.status) } };
  if (refined.bundle_adjustment)
    json = toJson(*refined.bundle_adjustment);
  if (refined.multi_view_icp)
    json["multi_view_icp"] = toJson(*refined.multi_view_icp, refined.keyframe_ids);
  json["status"] = toJson(refined.status);
  json["chosen"] = refined.chosen;
  json["compared"] = nlohmann::json::array();
  for (const pipeline::ComparedPoses& poses : refined.compared)
    json["compared"].push_back({ { "by", poses.by },
                                 { "depth", poses.score.depth },
                                 { "gray", poses.score.gray },
                                 { "pair_count", poses.score.pair_count } });
  return json;
}

std::string toText(const pipeline::SessionRefinement& refined)
{
  std::string text;
  if (refined.bundle_adjustment)
    text += toText(*refined.bundle_adjustment);
  if (refined.multi_view_icp)
    text += toText(*refined.multi_view_icp);
  if (!refined.status.message.empty() || text.empty())
    text += "refined   " + refined.status.message + "\n";
  return text;
}

}  // namespace object_modelling::cli
