#include "alignment_report.h"

#include <algorithm>

namespace object_modelling::benchmark_alignment
{
namespace
{
template <typename Condition>
Counts count(const std::vector<PairRow>& pairs, const Condition& condition)
{
  Counts counts;
  for (const PairRow& pair : pairs)
    if (condition(pair))
    {
      ++counts.pairs;
      ++(!pair.result.accepted ? counts.refused : pair.firstIsRight() ? counts.right : counts.wrong);
    }
  return counts;
}
}  // namespace

std::optional<int> PairRow::rankOfRight() const
{
  const auto first = std::find(right.begin(), right.end(), true);
  if (first == right.end())
    return std::nullopt;
  return static_cast<int>(first - right.begin()) + 1;
}

Summary summaryOf(const std::vector<PairRow>& pairs)
{
  const auto enough = [](const PairRow& pair) { return pair.true_overlap >= ENOUGH_OVERLAP_RATIO; };
  Summary summary;
  summary.enough = count(pairs, [&](const PairRow& pair) { return pair.same_object && enough(pair); });
  summary.little = count(pairs, [&](const PairRow& pair) { return pair.same_object && !enough(pair); });
  summary.cross = count(pairs, [](const PairRow& pair) { return !pair.same_object; });
  std::vector<double> seconds;
  for (const PairRow& pair : pairs)
    seconds.push_back(pair.seconds);
  std::sort(seconds.begin(), seconds.end());
  if (!seconds.empty())
  {
    summary.median_s = seconds[seconds.size() / 2];
    summary.max_s = seconds.back();
  }
  return summary;
}

}  // namespace object_modelling::benchmark_alignment
