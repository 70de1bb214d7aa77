#include <iomanip>
#include <sstream>

#include "alignment_report.h"

namespace object_modelling::benchmark_alignment
{
namespace
{
std::string fixed(double value, int digits)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

/// A row of a Markdown table.
std::string joined(const std::vector<std::string>& cells)
{
  std::string row = "|";
  for (const std::string& cell : cells)
    row += " " + cell + " |";
  return row + "\n";
}

std::string header(const std::vector<std::string>& names)
{
  return joined(names) + joined(std::vector<std::string>(names.size(), "---"));
}

std::string outcomeOf(const PairRow& pair)
{
  if (!pair.result.accepted)
    return "refused";
  return pair.firstIsRight() ? "right" : "WRONG";
}

std::string toText(const Counts& counts)
{
  return std::to_string(counts.right) + " right of " + std::to_string(counts.pairs) + ", " +
         std::to_string(counts.wrong) + " wrong accepted, " + std::to_string(counts.refused) + " refused\n";
}
}  // namespace

std::string sessionTable(const std::vector<SessionRow>& sessions)
{
  std::string table =
      header({ "session", "keyframes", "points", "spacing mm", "part s", "truth fits to mm", "mesh mm" });
  for (const SessionRow& session : sessions)
    if (session.problem.empty())
      table += joined({ session.id, std::to_string(session.keyframes), std::to_string(session.part.points.size()),
                        fixed(1e3 * session.part.spacing_m, 1), fixed(session.part_s, 2),
                        fixed(session.truth.camera_rmse_mm, 2), fixed(session.mesh_distance_mm, 2) });
  return table;
}

std::string pairTableHeader()
{
  return header({ "a", "b", "true overlap", "outcome", "deg", "mm", "mesh mm", "rank of right", "candidates", "kind",
                  "overlap", "fsv", "rmse mm", "contact mm", "colour", "texture", "probability", "s", "reason" });
}

std::string toTableRow(const PairRow& pair)
{
  std::vector<std::string> cells = { pair.a, pair.b, pair.same_object ? fixed(pair.true_overlap, 2) : "cross",
                                     outcomeOf(pair) };
  if (pair.same_object && !pair.errors.empty())
  {
    const CandidateErrors& errors = pair.errors.front();
    cells.insert(cells.end(),
                 { fixed(errors.rotation_deg, 2), fixed(errors.translation_mm, 2), fixed(errors.mesh_distance_mm, 2) });
  }
  else
    cells.insert(cells.end(), 3, "");
  const std::optional<int> rank = pair.rankOfRight();
  cells.push_back(rank ? std::to_string(*rank) : "");
  cells.push_back(std::to_string(pair.result.candidates.size()));
  if (!pair.result.candidates.empty())
  {
    const alignment::PairCandidate& first = pair.result.candidates.front();
    const registration::PairQuality& quality = first.quality;
    cells.insert(cells.end(),
                 { alignment::nameOf(first.kind), fixed(quality.overlap_ratio, 2), fixed(quality.fsv_ratio, 3),
                   fixed(1e3 * quality.rmse_m, 2), fixed(1e3 * quality.contact_gap_m, 1),
                   fixed(quality.color_agreement, 2), fixed(quality.texture, 3), fixed(quality.probability, 2) });
  }
  else
    cells.insert(cells.end(), 8, "");
  cells.push_back(fixed(pair.seconds, 2));
  cells.push_back(pair.result.reason);
  return joined(cells);
}

std::string summaryText(const std::vector<SessionRow>& sessions, const std::vector<PairRow>& pairs)
{
  const Summary summary = summaryOf(pairs);
  const std::string limit = fixed(100 * ENOUGH_OVERLAP_RATIO, 0) + " %: ";
  std::string text = "- pairs with true overlap >= " + limit + toText(summary.enough);
  text += "- pairs with true overlap < " + limit + toText(summary.little);
  text += "- cross pairs: " + std::to_string(summary.cross.wrong) + " accepted of " +
          std::to_string(summary.cross.pairs) + "\n";
  text += "- seconds per pair: median " + fixed(summary.median_s, 2) + ", max " + fixed(summary.max_s, 2) + "\n";
  for (const SessionRow& session : sessions)
    if (!session.problem.empty())
      text += "- left out: " + session.id + ": " + session.problem + "\n";
  return text;
}

}  // namespace object_modelling::benchmark_alignment
