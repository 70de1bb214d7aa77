#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "alignment_report.h"
#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::benchmark_alignment
{
/// What becomes of all sessions of one object, aligned together.
struct ObjectRow
{
  std::string object;
  std::vector<std::string> sessions;
  alignment::AlignmentResult result;
  double seconds = 0;
};

/// Objects of at least `min_sessions` sessions, in the order of their first ones.
std::vector<ObjectRow> alignTogether(const std::vector<SessionRow>& sessions, std::size_t min_sessions,
                                     const alignment::PairAlignmentOptions& options);

/// Markdown.
std::string toTable(const std::vector<ObjectRow>& rows);
nlohmann::json toJson(const std::vector<ObjectRow>& rows);

}  // namespace object_modelling::benchmark_alignment
