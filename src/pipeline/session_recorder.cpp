#include "object_modelling/pipeline/session_recorder.h"

#include <chrono>
#include <utility>

#include "object_modelling/base/options.h"

namespace object_modelling::pipeline
{
using base::Error;
using base::StatusCode;
using tracking::TrackingStatus;

std::vector<std::string> SessionRecorderOptions::violations() const
{
  base::OptionsCheck check("session_recorder");
  check.include(tracker.violations());
  check.include(follower.violations());
  return check.violations();
}

SessionRecorder::SessionRecorder(const SessionRecorderOptions& options, SessionSink* sink)
    : options_(base::checked(options)), sink_(sink), follower_(options.follower), tracker_(options.tracker)
{
}

void SessionRecorder::requireIdle() const
{
  if (recording_)
    throw Error(StatusCode::FAILED_PRECONDITION, "session '" + session_.id + "' is being recorded; finish it first");
}

EndedSession SessionRecorder::current() const
{
  if (!recording_)
    throw Error(StatusCode::FAILED_PRECONDITION, "nothing is being recorded; start a session first");
  return { session_.id, counts_.keyframe_count, created_ };
}

void SessionRecorder::begin(const keyframes::Session& session)
{
  tracker_.reset();
  follower_.reset();
  session_ = session;
  session_.reference_is_object = onObject();
  session_.calibration.noise_model = options_.noise_model;
  session_.closed = false;
  created_ = resumed_ = lost_ = false;
  newest_stamp_s_.reset();
  counts_ = {};
}

void SessionRecorder::create(const keyframes::Session& session)
{
  if (sink_ != nullptr)
    sink_->create(session);
  session_ = session;
  created_ = true;
}

void SessionRecorder::start(const keyframes::Session& session)
{
  requireIdle();
  begin(session);
  if (!session_.camera_frame_id.empty())
    create(session_);
  recording_ = true;
}

void SessionRecorder::resume(const std::string& session_id)
{
  requireIdle();
  if (sink_ == nullptr)
    throw Error(StatusCode::INVALID_ARGUMENT, "session '" + session_id + "' cannot be resumed where none is kept");
  const std::vector<rgbd::Keyframe> keyframes = sink_->stored(session_id, options_.noise_model);
  keyframes::Session session;
  session.id = session_id;
  begin(session);
  tracker_.resume(keyframes);
  sink_->reopen(session_id);  // last: a tracker that refuses leaves the session as it was
  counts_.keyframe_count = static_cast<int>(keyframes.size());
  created_ = resumed_ = recording_ = true;
}

void SessionRecorder::count(const tracking::TrackingResult& result)
{
  counts_.tracked_count += result.tracked();
  counts_.relocalised_count += result.status == TrackingStatus::RELOCALISED;
  counts_.lost_count += result.status == TrackingStatus::LOST && !lost_;
  lost_ = result.status == TrackingStatus::LOST;
}

RecordedFrame SessionRecorder::notNewer(rgbd::Frame frame)
{
  RecordedFrame refused;
  refused.newest_stamp_s = newest_stamp_s_;
  refused.result.stamp_s = frame.stamp_s;
  const bool has_map = counts_.tracked_count > 0 || resumed_;
  refused.result.status = has_map ? TrackingStatus::LOST : TrackingStatus::NOT_STARTED;
  refused.result.reason = "stamp " + std::to_string(frame.stamp_s) + " s is not newer than that of the last frame, " +
                          std::to_string(*newest_stamp_s_) + " s";
  refused.frame = std::move(frame);
  return refused;
}

void SessionRecorder::track(const std::optional<Eigen::Isometry3d>& T_robot_camera, RecordedFrame* recorded)
{
  using Clock = std::chrono::steady_clock;
  if (onObject())
  {
    // Without a mask the tracker itself reports that the frame cannot be placed.
    const segmentation::FollowedObject object = follower_.follow(recorded->frame);
    recorded->object = object.status;
    recorded->frame.object_mask = object.mask;
    recorded->frame.moving_mask = object.moving();
  }
  const Clock::time_point start = Clock::now();
  recorded->result = tracker_.track(recorded->frame, T_robot_camera);
  recorded->track_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

RecordedFrame SessionRecorder::process(rgbd::Frame frame, const std::string& camera_frame_id,
                                       const std::optional<Eigen::Isometry3d>& T_robot_camera)
{
  if (!current().created)
  {
    keyframes::Session session = session_;
    session.camera_frame_id = camera_frame_id;
    session.started_s = frame.stamp_s;
    create(session);
  }
  ++counts_.frame_count;
  if (newest_stamp_s_ && !(frame.stamp_s > *newest_stamp_s_))
  {
    RecordedFrame refused = notNewer(std::move(frame));
    count(refused.result);
    return refused;
  }
  newest_stamp_s_ = frame.stamp_s;
  RecordedFrame recorded;
  recorded.frame = std::move(frame);
  track(T_robot_camera, &recorded);
  count(recorded.result);
  if (recorded.result.keyframe)
  {
    if (sink_ != nullptr)
      sink_->add(session_.id, *recorded.result.keyframe, camera_frame_id);
    ++counts_.keyframe_count;
  }
  return recorded;
}

void SessionRecorder::finish()
{
  close(current());
  recording_ = false;
}

EndedSession SessionRecorder::end()
{
  const EndedSession ended = current();
  recording_ = false;
  return ended;
}

void SessionRecorder::close(const EndedSession& ended) const
{
  if (sink_ != nullptr && ended.created)
    sink_->close(ended.id, ended.keyframe_count);
}

void SessionRecorder::reset()
{
  if (recording_ && created_ && !resumed_ && sink_ != nullptr)
    sink_->discard(session_.id);
  recording_ = false;
  begin({});
}

}  // namespace object_modelling::pipeline
