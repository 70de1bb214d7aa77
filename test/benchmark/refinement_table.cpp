#include "refinement_table.h"

#include <iomanip>
#include <sstream>

namespace object_modelling::benchmark_refinement
{
namespace
{
std::string before_after(double before, double after, int digits)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << before << " -> " << after;
  return out.str();
}

nlohmann::json toJson(const PoseErrors& errors)
{
  return { { "ate_rmse_mm", errors.ate_rmse_mm },
           { "ate_max_mm", errors.ate_max_mm },
           { "rotation_rmse_deg", errors.rotation_rmse_deg },
           { "rotation_max_deg", errors.rotation_max_deg },
           { "view_rmse_mm", errors.view_rmse_mm } };
}
}  // namespace

std::string tableHeader()
{
  return "| recording | method | keyframes | pairs | left out | free | iterations | s | s of cores | peak MB | ATE "
         "RMSE mm "
         "| ATE max mm | rotation RMSE deg | middle of views RMSE mm |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

std::string toRow(const std::string& recording, const Measurement& measurement)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << "| " << recording << " | " << measurement.method << " | "
      << measurement.keyframes << " | " << measurement.pairs << " | " << measurement.left_out << " | "
      << measurement.free_directions << " | " << measurement.iterations << " | " << measurement.wall_s << " | "
      << measurement.cpu_s << " | " << std::setprecision(0) << measurement.peak_mb << " |";
  if (!measurement.problem.empty())
    out << " " << measurement.problem << " | | | |";
  else if (measurement.before && measurement.after)
    out << " " << before_after(measurement.before->ate_rmse_mm, measurement.after->ate_rmse_mm, 2) << " | "
        << before_after(measurement.before->ate_max_mm, measurement.after->ate_max_mm, 2) << " | "
        << before_after(measurement.before->rotation_rmse_deg, measurement.after->rotation_rmse_deg, 3) << " | "
        << before_after(measurement.before->view_rmse_mm, measurement.after->view_rmse_mm, 2) << " |";
  else
    out << " | | | |";
  return out.str() + "\n";
}

nlohmann::json toJson(const std::string& recording, const Measurement& measurement)
{
  nlohmann::json json = { { "recording", recording },
                          { "method", measurement.method },
                          { "keyframes", measurement.keyframes },
                          { "pairs", measurement.pairs },
                          { "left_out", measurement.left_out },
                          { "free_directions", measurement.free_directions },
                          { "iterations", measurement.iterations },
                          { "wall_s", measurement.wall_s },
                          { "cpu_s", measurement.cpu_s },
                          { "peak_mb", measurement.peak_mb },
                          { "rmse_mm", measurement.rmse_mm },
                          { "problem", measurement.problem } };
  if (measurement.before && measurement.after)
  {
    json["before"] = toJson(*measurement.before);
    json["after"] = toJson(*measurement.after);
  }
  return json;
}

}  // namespace object_modelling::benchmark_refinement
