#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/bundle_adjustment/bundle_adjustment.h"

namespace object_modelling::report
{
/// Stored figures of a session's last bundle adjustment; as in BundleAdjustmentResult.
struct RefinementReport
{
  int iterations = 0;
  double initial_cost = 0, final_cost = 0;
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();
  int link_count = 0, rejected_link_count = 0;
  std::vector<int> left_out;
  std::vector<bundle_adjustment::KeyframeResidual> residuals;
};

/// YAML text that is stored with the session (keyframes::Session::refinement_report).
std::string refinementReportYaml(const bundle_adjustment::BundleAdjustmentResult& result);
/// Nothing for an empty text: never refined. Throws base::Error (BAD_INPUT).
std::optional<RefinementReport> readRefinementReport(const std::string& yaml);

}  // namespace object_modelling::report
