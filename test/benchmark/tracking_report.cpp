#include "tracking_report.h"

#include <algorithm>

namespace object_modelling::benchmark_tracking
{
namespace
{
bool isCounted(const RecordingReport& report, const FrameRecord& frame)
{
  const double stamp_s = frame.result.stamp_s;
  return std::none_of(report.events.begin(), report.events.end(),
                      [stamp_s](const Event& event) { return stamp_s >= event.start_s && stamp_s <= event.end_s; });
}
}  // namespace

int keyframeCount(const Run& run)
{
  return static_cast<int>(
      std::count_if(run.frames.begin(), run.frames.end(), [](const FrameRecord& frame) { return frame.keyframe; }));
}

int relocalisedCount(const Run& run)
{
  return static_cast<int>(std::count_if(run.frames.begin(), run.frames.end(),
                                        [](const FrameRecord& frame)
                                        { return frame.result.status == tracking::TrackingStatus::RELOCALISED; }));
}

int frameCount(const RecordingReport& report)
{
  const std::vector<FrameRecord>& frames = report.runs.front().frames;
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [&report](const FrameRecord& frame) { return isCounted(report, frame); }));
}

int trackedCount(const RecordingReport& report)
{
  const std::vector<FrameRecord>& frames = report.runs.front().frames;
  return static_cast<int>(std::count_if(frames.begin(), frames.end(),
                                        [&report](const FrameRecord& frame)
                                        { return isCounted(report, frame) && frame.result.tracked(); }));
}

}  // namespace object_modelling::benchmark_tracking
