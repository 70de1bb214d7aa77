#include <cmath>
#include <iomanip>
#include <sstream>

#include "object_modelling/report/result_text.h"

namespace object_modelling::report
{
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
      // Rounded down: what is short of a limit does not look like it.
      out << " (probability " << std::floor(100 * best->quality.probability) / 100 << ", overlap "
          << best->quality.overlap_ratio << ", free-space violation " << best->quality.fsv_ratio << ", surfaces "
          << 1000 * best->quality.rmse_m << " mm apart, colours " << best->quality.color_agreement << ")";
    out << (edge.reason.empty() ? "" : "\n          " + edge.reason) << "\n";
  }
  for (const alignment::SessionPlacement& placed : result.placements)
    out << "placed    " << placed.session_id << "\n";
  for (const std::string& id : result.left_out)
    out << "left out  " << id << "\n";
  return out.str();
}

}  // namespace object_modelling::report
