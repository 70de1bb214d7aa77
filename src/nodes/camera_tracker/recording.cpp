#include "recording.h"

#include <ctime>
#include <utility>

#include "object_modelling/ros_bridge/frame_conversion.h"
#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::nodes
{
namespace
{
/// session_<date>_<time>_<milliseconds>, UTC.
std::string idOf(const ros::Time& stamp)
{
  const std::time_t seconds = stamp.sec;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char date[32], milliseconds[8];
  std::strftime(date, sizeof(date), "session_%Y%m%d_%H%M%S", &utc);
  std::snprintf(milliseconds, sizeof(milliseconds), "_%03u", stamp.nsec / 1000000 % 1000);
  return std::string(date) + milliseconds;
}

void requireId(const std::string& id, const std::string& what)
{
  if (!keyframes::isValidId(id))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      what + " '" + id + "' must be 1 to 64 of A-Z a-z 0-9 _ . - and not begin with . or -");
}

void describe(const tracking::TrackingResult& result, TrackingState* state)
{
  state->reason = result.reason;
  state->feature_count = result.feature_count;
  state->inlier_count = result.inlier_count;
  state->reprojection_rmse_px = static_cast<float>(result.reprojection_rmse_px);
  state->speed_m_per_s = static_cast<float>(result.speed_m_per_s);
  state->angular_speed_rad_per_s = static_cast<float>(result.angular_speed_rad_per_s);
  state->blur_ratio = static_cast<float>(result.blur_ratio);
}

std::string notNewer(double stamp_s, double newest_stamp_s)
{
  return "stamp " + std::to_string(stamp_s) + " s is not newer than " + std::to_string(newest_stamp_s) +
         " s, the newest of this session: is a recording played again, or has a clock been set back? Call ~stop and "
         "~start for a new session";
}
}  // namespace

Recording::Recording(const CameraTrackerNodeOptions& options, SessionRecord& record)
    : options_(options),
      record_(record),
      builder_(options.frame),
      recorder_({ options.tracker, options.follower, options.frame.noise_model }, &record)
{
}

std::string Recording::start(const std::string& session_id, const std::string& object_id, bool resume,
                             const ros::Time& now)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (recorder_.recording())
    throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                      "session '" + recorder_.session().id + "' is being recorded; call ~stop first");
  if (resume && (!record_.stores() || session_id.empty()))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "resume needs the id of a stored session, and use_store to be true");
  keyframes::Session session;
  session.id = session_id.empty() ? idOf(now) : session_id;
  session.object_id = object_id;
  requireId(session.id, "session id");
  if (!object_id.empty())
    requireId(object_id, "object id");

  if (resume)
    recorder_.resume(session.id);
  else
  {
    if (session_id.empty())
      session.id = record_.freeId(session.id);
    else
      record_.requireFree(session.id);
    recorder_.start(session);
  }
  status_ = tracking::TrackingStatus::NOT_STARTED;
  dropped_frames_ = 0;
  robot_problem_.clear();
  return session.id;
}

TrackingState Recording::stop(base::Status* stored)
{
  TrackingState ended;
  pipeline::EndedSession session;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!recorder_.recording())
      throw base::Error(base::StatusCode::FAILED_PRECONDITION, "nothing is being recorded; call ~start first");
    count(&ended);
    session = recorder_.end();
    status_ = tracking::TrackingStatus::NOT_STARTED;
  }
  *stored = ros_bridge::guarded([&] { recorder_.close(session); });
  return ended;
}

std::string Recording::reset()
{
  std::string left;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (recorder_.recording())
      left = recorder_.session().id;
  }
  base::Status stored;
  if (!left.empty())
    stop(&stored);
  const std::lock_guard<std::mutex> lock(mutex_);
  recorder_.reset();
  status_ = tracking::TrackingStatus::NOT_STARTED;
  dropped_frames_ = 0;
  if (!stored.ok())
    throw base::Error(stored.code, stored.message);
  return left;
}

rgbd::Frame Recording::frameOf(const FrameMessages& messages)
{
  if (options_.require_registered)
  {
    const base::Status registered = ros_bridge::checkRegistered(messages.color->header, messages.depth->header);
    if (!registered.ok())
      throw base::Error(registered.code, registered.message + " (or set require_registered to false)");
  }
  rgbd::RawFrame raw = ros_bridge::rawFrameFromMessages(*messages.color, *messages.depth, *messages.info,
                                                        ros_bridge::ImageKind::RECTIFIED);
  if (messages.object_mask)
    raw.object_mask = ros_bridge::maskFromMessage(*messages.object_mask);
  base::Result<rgbd::Frame> frame = builder_.build(raw);
  if (!frame.ok())
    throw base::Error(frame.status.code, frame.status.message);
  return std::move(frame.value);
}

void Recording::record(const std_msgs::Header& header, const RobotPose& robot, TrackedFrame* tracked)
{
  pipeline::RecordedFrame recorded = recorder_.process(*tracked->frame, header.frame_id, robot.T_robot_camera);
  if (recorded.newest_stamp_s)
    recorded.result.reason = notNewer(header.stamp.toSec(), *recorded.newest_stamp_s);
  if (!recorded.object.ok())
    recorded.result.reason = "no object in view: " + recorded.object.message;
  status_ = recorded.result.status;
  tracked->state.robot_motion_used = robot.T_robot_camera.has_value() && !recorded.newest_stamp_s;
  tracked->frame = std::move(recorded.frame);
  tracked->result = std::move(recorded.result);
}

void Recording::setLost()
{
  if (status_ != tracking::TrackingStatus::NOT_STARTED)
    status_ = tracking::TrackingStatus::LOST;
}

void Recording::count(TrackingState* state) const
{
  const pipeline::RecordingCounts& counts = recorder_.counts();
  state->recording = recorder_.recording();
  state->session_id = recorder_.session().id;
  state->status = static_cast<std::uint8_t>(status_);
  state->input_ok = input_ok_;
  state->keyframe_count = counts.keyframe_count;
  state->frame_count = counts.frame_count;
  state->tracked_count = counts.tracked_count;
  state->dropped_frames = dropped_frames_;
}

void Recording::say(const RobotPose& robot, std::string* reason)
{
  if (!robot.problem.empty() && robot.problem != robot_problem_)
    *reason += (reason->empty() ? "" : "; ") + robot.problem + (robot.detail.empty() ? "" : " (" + robot.detail + ")");
  robot_problem_ = robot.problem;
}

TrackedFrame Recording::process(const FrameMessages& messages, std::size_t dropped_count, const RobotPose& robot)
{
  const ros::WallTime begin = ros::WallTime::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool recording = recorder_.recording();
  if (recording)
    dropped_frames_ += static_cast<int>(dropped_count);
  TrackedFrame tracked;
  const base::Status usable = ros_bridge::guarded([&] { tracked.frame = frameOf(messages); });
  base::Status done = usable;
  if (usable.ok() && recording)
    done = ros_bridge::guarded([&] { record(messages.color->header, robot, &tracked); });
  if (!done.ok())
    setLost();
  input_ok_ = usable.ok();
  count(&tracked.state);
  if (tracked.result)
    describe(*tracked.result, &tracked.state);
  if (!done.ok())
    tracked.state.reason = done.message;
  if (recording)
    say(robot, &tracked.state.reason);
  tracked.state.header = messages.color->header;
  tracked.state.processing_s = static_cast<float>((ros::WallTime::now() - begin).toSec());
  return tracked;
}

TrackingState Recording::state(const ros::Time& now)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  TrackingState state;
  count(&state);
  state.header.stamp = now;
  return state;
}

TrackingState Recording::inputProblem(const std::string& reason, const ros::Time& now)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    setLost();
    input_ok_ = false;
  }
  TrackingState problem = state(now);
  problem.reason = reason;
  return problem;
}

}  // namespace object_modelling::nodes
