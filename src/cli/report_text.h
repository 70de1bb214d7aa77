#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "object_modelling/pipeline/build_object.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/pipeline/session_refinement.h"
#include "object_modelling/report/result_text.h"

// Reports of the pipeline as JSON (units in the keys) and as text.
namespace object_modelling::cli
{
nlohmann::json toJson(const base::Status& status);
nlohmann::json toJson(const pipeline::RecordReport& report);
nlohmann::json toJson(const bundle_adjustment::BundleAdjustmentResult& result);
/// `keyframe_ids`: of the views.
nlohmann::json toJson(const multi_view_icp::MultiViewIcpResult& result, const std::vector<int>& keyframe_ids);
/// As of bundle adjustment where that took part, with the result of multi-view ICP under "multi_view_icp".
nlohmann::json toJson(const pipeline::SessionRefinement& refined);
nlohmann::json toJson(const pipeline::SegmentReport& report);
nlohmann::json toJson(const alignment::AlignmentResult& result);
nlohmann::json toJson(const pipeline::BuildReport& report);

using report::toText;
std::string toText(const pipeline::RecordReport& report);
std::string toText(const pipeline::SessionRefinement& refined);
std::string toText(const pipeline::SegmentReport& report);
std::string toText(const pipeline::BuildReport& report);

}  // namespace object_modelling::cli
