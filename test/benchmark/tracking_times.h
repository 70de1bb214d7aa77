#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tracking_run.h"

namespace object_modelling::benchmark_tracking
{
struct TimeStatistics
{
  double median_ms = 0, p95_ms = 0, max_ms = 0, mean_ms = 0;
};

/// p-quantile as the value of rank floor(p (n - 1)).
TimeStatistics timeStatisticsOf(std::vector<double> values_ms);

/// Wall time of one frame by stage, in the order of tracking::StageTimes; "other" is what no stage claims.
std::vector<std::pair<std::string, double>> stageTimes(const FrameRecord& frame);

/// Of several runs: each figure is the median of that of the runs. Rows: wall, cpu, then the stages.
std::vector<std::pair<std::string, TimeStatistics>> timeTable(const std::vector<Run>& runs);

}  // namespace object_modelling::benchmark_tracking
