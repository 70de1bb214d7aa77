#include "alignment_growth.h"

#include <chrono>
#include <iomanip>
#include <sstream>

namespace object_modelling::benchmark_alignment
{
namespace
{
template <typename Work>
double secondsOf(const Work& work)
{
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
}  // namespace

std::vector<GrowthRow> measureGrowth(const std::vector<registration::PartialModel>& parts,
                                     const alignment::PairAlignmentOptions& options)
{
  std::vector<GrowthRow> rows;
  std::vector<alignment::AlignmentEdge> known;
  base::JobControl control;
  for (std::size_t count = 2; count <= parts.size(); ++count)
  {
    const std::vector<registration::PartialModel> first(parts.begin(),
                                                        parts.begin() + static_cast<std::ptrdiff_t>(count));
    GrowthRow row;
    row.sessions = count;
    alignment::AlignmentResult result;
    row.one_more_s = secondsOf([&] { result = alignment::alignSessions(first, known, options, control); });
    row.all_s = secondsOf([&] { result = alignment::alignSessions(first, {}, options, control); });
    row.placed = result.placements.size();
    known = result.edges;
    rows.push_back(row);
  }
  return rows;
}

std::string toTable(const std::vector<GrowthRow>& rows)
{
  std::ostringstream out;
  out << std::fixed << std::setprecision(2)
      << "| sessions | placed | all pairs s | one more s |\n| --- | --- | --- | --- |\n";
  for (const GrowthRow& row : rows)
    out << "| " << row.sessions << " | " << row.placed << " | " << row.all_s << " | " << row.one_more_s << " |\n";
  return out.str();
}

nlohmann::json toJson(const std::vector<GrowthRow>& rows)
{
  nlohmann::json json = nlohmann::json::array();
  for (const GrowthRow& row : rows)
    json.push_back({ { "sessions", row.sessions },
                     { "placed", row.placed },
                     { "all_s", row.all_s },
                     { "one_more_s", row.one_more_s } });
  return json;
}

}  // namespace object_modelling::benchmark_alignment
