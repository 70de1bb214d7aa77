#include "tracking_times.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace object_modelling::benchmark_tracking
{
namespace
{
double medianOf(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

using ValueOf = std::function<double(const FrameRecord&)>;

TimeStatistics medianOfRuns(const std::vector<Run>& runs, const ValueOf& value_of)
{
  std::vector<double> median, p95, max, mean;
  for (const Run& run : runs)
  {
    std::vector<double> values;
    for (const FrameRecord& frame : run.frames)
      values.push_back(value_of(frame));
    const TimeStatistics of_run = timeStatisticsOf(std::move(values));
    median.push_back(of_run.median_ms);
    p95.push_back(of_run.p95_ms);
    max.push_back(of_run.max_ms);
    mean.push_back(of_run.mean_ms);
  }
  return { medianOf(median), medianOf(p95), medianOf(max), medianOf(mean) };
}
}  // namespace

TimeStatistics timeStatisticsOf(std::vector<double> values_ms)
{
  if (values_ms.empty())
    return {};
  std::sort(values_ms.begin(), values_ms.end());
  const auto at = [&values_ms](double share)
  { return values_ms[static_cast<std::size_t>(share * static_cast<double>(values_ms.size() - 1))]; };
  const double sum = std::accumulate(values_ms.begin(), values_ms.end(), 0.0);
  return { at(0.5), at(0.95), at(1), sum / static_cast<double>(values_ms.size()) };
}

std::vector<std::pair<std::string, double>> stageTimes(const FrameRecord& frame)
{
  const tracking::StageTimes& times = frame.result.times;
  std::vector<std::pair<std::string, double>> stages = { { "pyramid", times.pyramid_ms },
                                                         { "flow", times.flow_ms },
                                                         { "map", times.map_ms },
                                                         { "dense", times.dense_ms },
                                                         { "recognition", times.recognition_ms },
                                                         { "keyframe", times.keyframe_ms } };
  double claimed_ms = 0;
  for (const auto& [name, stage_ms] : stages)
    claimed_ms += stage_ms;
  stages.emplace_back("other", std::max(0.0, frame.wall_ms - claimed_ms));
  return stages;
}

std::vector<std::pair<std::string, TimeStatistics>> timeTable(const std::vector<Run>& runs)
{
  std::vector<std::pair<std::string, TimeStatistics>> rows = {
    { "wall", medianOfRuns(runs, [](const FrameRecord& frame) { return frame.wall_ms; }) },
    { "cpu", medianOfRuns(runs, [](const FrameRecord& frame) { return frame.cpu_ms; }) }
  };
  const std::vector<std::pair<std::string, double>> names = stageTimes({});
  for (std::size_t i = 0; i < names.size(); ++i)
    rows.emplace_back(names[i].first,
                      medianOfRuns(runs, [i](const FrameRecord& frame) { return stageTimes(frame)[i].second; }));
  return rows;
}

}  // namespace object_modelling::benchmark_tracking
