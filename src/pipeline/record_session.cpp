#include "object_modelling/pipeline/record_session.h"

#include <optional>

#include "object_modelling/base/options.h"
#include "object_modelling/pipeline/session_recorder.h"

namespace object_modelling::pipeline
{
namespace
{
void note(const std::string& problem, RecordReport* report)
{
  if (report->first_problem.empty())
    report->first_problem = problem;
}

void note(const RecordedFrame& recorded, RecordReport* report)
{
  const std::string name = "frame " + std::to_string(report->frame_count - 1);
  if (!recorded.object.ok())
    note(name + ": " + recorded.object.message, report);
  if (recorded.result.tracked())
    report->trajectory.push_back({ recorded.result.stamp_s, recorded.result.T_session_camera });
  else
    note(name + " not tracked: " + recorded.result.reason, report);
  report->track_ms.push_back(recorded.track_ms);
}

/// All frames of the recording.
RecordReport recordFrames(source::FrameSource& source, const RecordOptions& options, SessionRecorder& recorder,
                          base::JobControl& control)
{
  rgbd::FrameBuilder builder(options.frame);
  RecordReport report;
  report.session_id = recorder.session().id;
  const std::string camera_frame_id = source.frameId();
  while (const std::optional<rgbd::RawFrame> raw = source.next())
  {
    control.report("track", report.frame_count, source.size().value_or(0));
    ++report.frame_count;
    base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (frame.ok())
      note(recorder.process(std::move(frame.value), camera_frame_id), &report);
    else
    {
      ++report.unusable_count;
      note("frame " + std::to_string(report.frame_count - 1) + " unusable: " + frame.status.message, &report);
    }
  }
  control.report("track", report.frame_count, report.frame_count);
  const RecordingCounts& counts = recorder.counts();
  report.tracked_count = counts.tracked_count;
  report.lost_count = counts.lost_count;
  report.relocalised_count = counts.relocalised_count;
  report.keyframe_count = counts.keyframe_count;
  return report;
}

void requireUsable(const RecordReport& report, const std::string& recording, double max_unusable_ratio)
{
  const std::string prefix = "recording '" + recording + "': ";
  if (report.frame_count == 0)
    throw base::Error(base::StatusCode::BAD_INPUT, prefix + "has no frames");
  if (report.unusable_count > max_unusable_ratio * report.frame_count)
    throw base::Error(base::StatusCode::BAD_INPUT, prefix + std::to_string(report.unusable_count) + " of " +
                                                       std::to_string(report.frame_count) +
                                                       " frames are unusable; first problem: " + report.first_problem);
  if (report.keyframe_count == 0)
    throw base::Error(base::StatusCode::BAD_INPUT,
                      prefix + "no frame could be tracked; first problem: " + report.first_problem);
}
}  // namespace

std::vector<std::string> RecordOptions::violations() const
{
  base::OptionsCheck check("record_session");
  check.inRange("max_unusable_ratio", max_unusable_ratio, 0.0, 1.0);
  check.include(frame.violations());
  check.include(tracker.violations());
  check.include(follower.violations());
  return check.violations();
}

RecordReport recordSession(source::FrameSource& source, const keyframes::Session& session,
                           keyframes::SessionStore* store, const RecordOptions& options, base::JobControl& control)
{
  base::checked(options);
  std::optional<StoreSink> sink;
  if (store != nullptr)
    sink.emplace(*store);
  SessionRecorder recorder({ options.tracker, options.follower, options.frame.noise_model }, sink ? &*sink : nullptr);
  keyframes::Session recorded = session;
  recorded.camera_frame_id = source.frameId();
  recorder.start(recorded);
  try
  {
    RecordReport report = recordFrames(source, options, recorder, control);
    requireUsable(report, source.name(), options.max_unusable_ratio);
    recorder.finish();
    return report;
  }
  catch (...)
  {
    recorder.reset();
    throw;
  }
}

}  // namespace object_modelling::pipeline
