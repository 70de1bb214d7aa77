#include "object_modelling/pipeline/record_session.h"

#include <chrono>

#include <glog/logging.h>

#include "object_modelling/base/options.h"

namespace object_modelling::pipeline
{
namespace
{
using Clock = std::chrono::steady_clock;

/// Removes the session again unless the recording came to its end.
class SessionTransaction
{
public:
  SessionTransaction(keyframes::SessionStore* store, keyframes::Session session)
      : store_(store), session_(std::move(session))
  {
    session_.closed = false;
    if (store_)
      store_->createSession(session_);
  }
  ~SessionTransaction()
  {
    if (!store_ || committed_)
      return;
    try
    {
      store_->deleteSession(session_.id);
    }
    catch (const base::Error& error)
    {
      LOG(ERROR) << "session '" << session_.id << "' of a failed recording stays in the store: " << error.what();
    }
  }
  void add(const rgbd::Keyframe& keyframe)
  {
    if (store_)
      store_->addKeyframe(session_.id, keyframe);
  }
  void commit()
  {
    if (store_)
    {
      keyframes::SessionChange change;
      change.closed = true;
      store_->update(session_.id, change);
    }
    committed_ = true;
  }

private:
  keyframes::SessionStore* store_;
  keyframes::Session session_;
  bool committed_ = false;
};

void note(const std::string& problem, RecordReport* report)
{
  if (report->first_problem.empty())
    report->first_problem = problem;
}

void add(const tracking::TrackingResult& result, bool was_lost, RecordReport* report)
{
  if (result.tracked())
  {
    ++report->tracked_count;
    report->trajectory.push_back({ result.stamp_s, result.T_session_camera });
    report->relocalised_count += result.status == tracking::TrackingStatus::RELOCALISED;
  }
  else
  {
    if (!was_lost && result.status == tracking::TrackingStatus::LOST)
      ++report->lost_count;
    note("frame " + std::to_string(report->frame_count - 1) + " not tracked: " + result.reason, report);
  }
  report->keyframe_count += result.keyframe.has_value();
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
  const bool object_reference = options.tracker.reference == tracking::Reference::OBJECT;
  rgbd::FrameBuilder builder(options.frame);
  tracking::CameraTracker tracker(options.tracker);
  segmentation::ObjectFollower follower(options.follower);

  keyframes::Session recorded = session;
  recorded.camera_frame_id = source.frameId();
  recorded.reference_is_object = object_reference;
  recorded.calibration.noise_model = options.frame.noise_model;
  SessionTransaction transaction(store, recorded);

  RecordReport report;
  report.session_id = session.id;
  bool was_lost = false;
  while (const std::optional<rgbd::RawFrame> raw = source.next())
  {
    control.report("track", report.frame_count, source.size().value_or(0));
    ++report.frame_count;
    base::Result<rgbd::Frame> frame = builder.build(*raw);
    if (!frame.ok())
    {
      ++report.unusable_count;
      note("frame " + std::to_string(report.frame_count - 1) + " unusable: " + frame.status.message, &report);
      continue;
    }
    segmentation::FollowedObject followed;
    if (object_reference)
    {
      // Without a mask the tracker says itself that the frame cannot be placed.
      followed = follower.follow(frame.value);
      if (!followed.status.ok())
        note("frame " + std::to_string(report.frame_count - 1) + ": " + followed.status.message, &report);
      frame.value.object_mask = followed.moving();
    }
    const Clock::time_point start = Clock::now();
    tracking::TrackingResult result = tracker.track(frame.value);
    report.track_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    if (result.keyframe)
    {
      // A turntable helps to track the object and is no part of it.
      if (object_reference)
        result.keyframe->frame.object_mask = followed.mask;
      transaction.add(*result.keyframe);
    }
    add(result, was_lost, &report);
    was_lost = result.status == tracking::TrackingStatus::LOST;
  }
  control.report("track", report.frame_count, report.frame_count);

  const std::string prefix = "recording '" + source.name() + "': ";
  if (report.frame_count == 0)
    throw base::Error(base::StatusCode::BAD_INPUT, prefix + "has no frames");
  if (report.unusable_count > options.max_unusable_ratio * report.frame_count)
    throw base::Error(base::StatusCode::BAD_INPUT, prefix + std::to_string(report.unusable_count) + " of " +
                                                       std::to_string(report.frame_count) +
                                                       " frames are unusable; first problem: " + report.first_problem);
  if (report.keyframe_count == 0)
    throw base::Error(base::StatusCode::BAD_INPUT,
                      prefix + "no frame could be tracked; first problem: " + report.first_problem);
  transaction.commit();
  return report;
}

}  // namespace object_modelling::pipeline
