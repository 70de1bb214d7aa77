#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::benchmark_alignment
{
/// Time to align the first 2, 3, ... of these sessions.
struct GrowthRow
{
  std::size_t sessions = 0, placed = 0;
  double all_s = 0;       ///< every pair
  double one_more_s = 0;  ///< the last one, the others being known
};

std::vector<GrowthRow> measureGrowth(const std::vector<registration::PartialModel>& parts,
                                     const alignment::PairAlignmentOptions& options);

/// Markdown.
std::string toTable(const std::vector<GrowthRow>& rows);
nlohmann::json toJson(const std::vector<GrowthRow>& rows);

}  // namespace object_modelling::benchmark_alignment
