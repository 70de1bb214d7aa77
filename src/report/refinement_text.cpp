#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "object_modelling/report/result_text.h"

namespace object_modelling::report
{
namespace
{
constexpr double DEG_PER_RAD = 180 / M_PI;

/// Root mean square over all observations of the keyframes, by the member that holds a keyframe's own.
double rmseOf(const std::vector<bundle_adjustment::KeyframeResidual>& residuals,
              double bundle_adjustment::KeyframeResidual::*rmse)
{
  double sum = 0;
  double count = 0;
  for (const bundle_adjustment::KeyframeResidual& residual : residuals)
  {
    sum += residual.observation_count * residual.*rmse * residual.*rmse;
    count += residual.observation_count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}
}  // namespace

std::string toText(const bundle_adjustment::BundleAdjustmentResult& result)
{
  using Residual = bundle_adjustment::KeyframeResidual;
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << "refined   " << result.residuals.size() << " keyframes, "
      << result.links.size() << " new links; reprojection "
      << rmseOf(result.residuals, &Residual::reprojection_rmse_before_px) << " -> "
      << rmseOf(result.residuals, &Residual::reprojection_rmse_after_px) << " px, depth "
      << 1000 * rmseOf(result.residuals, &Residual::depth_rmse_before_m) << " -> "
      << 1000 * rmseOf(result.residuals, &Residual::depth_rmse_after_m) << " mm RMSE";
  if (!result.left_out.empty())
    out << "; " << result.left_out.size() << " left out (nothing links them)";
  if (!result.color_offset_px.isZero())
    out << "; colour is shifted by (" << result.color_offset_px.x() << ", " << result.color_offset_px.y()
        << ") px against depth";
  out << "\n";
  if (!result.status.ok())
    out << "          " << result.status.message << "\n";
  for (const bundle_adjustment::KeyframeLink& link : result.links)
    if (link.keyframe_b - link.keyframe_a == static_cast<int>(result.residuals.size()) - 1)
      out << "closure   keyframe " << link.keyframe_b << " against " << link.keyframe_a << ": "
          << 1000 * link.translation_error_before_m << " mm, " << DEG_PER_RAD * link.rotation_error_before_rad
          << " deg before -> " << 1000 * link.translation_error_after_m << " mm, "
          << DEG_PER_RAD * link.rotation_error_after_rad << " deg after\n";
  return out.str();
}

std::string toText(const multi_view_icp::MultiViewIcpResult& result)
{
  if (!result.status.ok())
    return "aligned   " + result.status.message + "\n";
  double squared_before = 0, squared_after = 0, count = 0;
  for (const multi_view_icp::IcpPair& pair : result.pairs)
  {
    squared_before += pair.point_count * pair.rmse_before_m * pair.rmse_before_m;
    squared_after += pair.point_count * pair.rmse_after_m * pair.rmse_after_m;
    count += pair.point_count;
  }
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << "aligned   " << result.residuals.size() << " keyframes in "
      << result.pairs.size() << " overlaps, " << result.iterations << " iterations; surfaces "
      << 1000 * std::sqrt(squared_before / std::max(1.0, count)) << " -> "
      << 1000 * std::sqrt(squared_after / std::max(1.0, count)) << " mm RMSE";
  if (!result.left_out.empty())
    out << "; " << result.left_out.size() << " left out (overlap with none, or do not fit)";
  if (!result.free_directions.empty())
    out << "; " << result.free_directions.size() << " directions of keyframes are held by nothing";
  return out.str() + "\n";
}

}  // namespace object_modelling::report
