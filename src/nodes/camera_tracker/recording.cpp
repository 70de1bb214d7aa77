#include "recording.h"

#include <ctime>
#include <sstream>

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
  state->status = static_cast<std::uint8_t>(result.status);
  state->reason = result.reason;
  state->feature_count = result.feature_count;
  state->inlier_count = result.inlier_count;
  state->reprojection_rmse_px = static_cast<float>(result.reprojection_rmse_px);
  state->speed_m_per_s = static_cast<float>(result.speed_m_per_s);
  state->angular_speed_rad_per_s = static_cast<float>(result.angular_speed_rad_per_s);
  state->blur_ratio = static_cast<float>(result.blur_ratio);
}
}  // namespace

Recording::Recording(const CameraTrackerNodeOptions& options, SessionRecord* record)
    : options_(options),
      record_(record),
      builder_(options.frame),
      follower_(options.follower),
      tracker_(options.tracker)
{
}

std::string Recording::start(const std::string& session_id, const std::string& object_id, bool resume,
                             const ros::Time& now)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (state_.recording)
    throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                      "session '" + session_.id + "' is being recorded; call ~stop first");
  if (resume && (record_ == nullptr || session_id.empty()))
    throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                      "resume needs the id of a stored session, and use_store to be true");
  keyframes::Session session;
  session.id = session_id.empty() ? idOf(now) : session_id;
  session.object_id = object_id;
  session.reference_is_object = options_.tracker.reference == tracking::Reference::OBJECT;
  session.calibration.noise_model = options_.frame.noise_model;
  requireId(session.id, "session id");
  if (!object_id.empty())
    requireId(object_id, "object id");

  tracker_.reset();
  follower_.reset();
  last_stamp_ = ros::Time();
  robot_problem_.clear();
  int keyframe_count = 0;
  if (resume)
  {
    const std::vector<rgbd::Keyframe> keyframes = record_->reopen(session.id, options_.frame.noise_model);
    tracker_.resume(keyframes);
    keyframe_count = static_cast<int>(keyframes.size());
  }
  else if (record_ != nullptr && session_id.empty())
    session.id = record_->freeId(session.id);
  else if (record_ != nullptr)
    record_->requireFree(session.id);

  session_ = session;
  created_ = record_ == nullptr || resume;
  sent_keyframes_ = keyframe_count;
  const bool input_ok = state_.input_ok;
  state_ = TrackingState();
  state_.input_ok = input_ok;
  state_.recording = true;
  state_.session_id = session.id;
  state_.keyframe_count = keyframe_count;
  return session.id;
}

TrackingState Recording::stop(base::Status* stored)
{
  TrackingState ended;
  bool in_store = false;
  int sent_keyframes = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!state_.recording)
      throw base::Error(base::StatusCode::FAILED_PRECONDITION, "nothing is being recorded; call ~start first");
    ended = state_;
    state_.recording = false;
    state_.status = TrackingState::NOT_STARTED;
    in_store = record_ != nullptr && created_;
    sent_keyframes = sent_keyframes_;
  }
  if (in_store)
    *stored = ros_bridge::guarded([&] { record_->finish(ended.session_id, sent_keyframes); });
  return ended;
}

std::string Recording::reset()
{
  std::string left;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state_.recording)
      left = session_.id;
  }
  base::Status stored;
  if (!left.empty())
    stop(&stored);
  const std::lock_guard<std::mutex> lock(mutex_);
  tracker_.reset();
  const bool input_ok = state_.input_ok;
  state_ = TrackingState();
  state_.input_ok = input_ok;
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

void Recording::createSession(const std_msgs::Header& header)
{
  if (created_)
    return;
  session_.camera_frame_id = header.frame_id;
  session_.started_s = header.stamp.toSec();
  record_->create(session_);
  created_ = true;
}

void Recording::requireNewer(const ros::Time& stamp)
{
  if (!last_stamp_.isZero() && stamp <= last_stamp_)
  {
    std::ostringstream text;
    text << std::fixed << "stamp " << stamp.toSec() << " s is not newer than " << last_stamp_.toSec()
         << " s, the newest of this session: is a recording played again, or has a clock been set back? Call ~stop and "
            "~start for a new session";
    throw base::Error(base::StatusCode::BAD_INPUT, text.str());
  }
  last_stamp_ = stamp;
}

void Recording::track(const std_msgs::Header& header, const RobotPose& robot, TrackedFrame* tracked)
{
  rgbd::Frame& frame = *tracked->frame;
  createSession(header);
  ++state_.frame_count;
  requireNewer(header.stamp);
  segmentation::FollowedObject object;
  if (options_.tracker.reference == tracking::Reference::OBJECT)
  {
    object = follower_.follow(frame);
    frame.object_mask = object.moving();
  }
  tracked->result = tracker_.track(frame, robot.T_robot_camera);
  tracking::TrackingResult& result = *tracked->result;
  if (!object.status.ok())
    result.reason = "no object in view: " + object.status.message;
  state_.tracked_count += result.tracked() ? 1 : 0;
  if (result.keyframe)
  {
    // A turntable helps to track the object and is no part of it.
    if (options_.tracker.reference == tracking::Reference::OBJECT)
      result.keyframe->frame.object_mask = object.mask;
    ++state_.keyframe_count;
    ++sent_keyframes_;
  }
  state_.status = static_cast<std::uint8_t>(result.status);
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
  if (state_.recording)
    state_.dropped_frames += static_cast<int>(dropped_count);
  TrackedFrame tracked;
  const base::Status usable = ros_bridge::guarded([&] { tracked.frame = frameOf(messages); });
  base::Status done = usable;
  if (usable.ok() && state_.recording)
    done = ros_bridge::guarded([&] { track(messages.color->header, robot, &tracked); });
  if (!done.ok() && state_.status != TrackingState::NOT_STARTED)
    state_.status = TrackingState::LOST;
  state_.input_ok = usable.ok();
  tracked.state = state_;
  if (tracked.result)
  {
    describe(*tracked.result, &tracked.state);
    tracked.state.robot_motion_used = robot.T_robot_camera.has_value();
  }
  if (!done.ok())
    tracked.state.reason = done.message;
  if (state_.recording)
    say(robot, &tracked.state.reason);
  tracked.state.header = messages.color->header;
  tracked.state.processing_s = static_cast<float>((ros::WallTime::now() - begin).toSec());
  return tracked;
}

TrackingState Recording::state(const ros::Time& now)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  TrackingState state = state_;
  state.header.stamp = now;
  return state;
}

TrackingState Recording::inputProblem(const std::string& reason, const ros::Time& now)
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state_.status != TrackingState::NOT_STARTED)
      state_.status = TrackingState::LOST;
    state_.input_ok = false;
  }
  TrackingState problem = state(now);
  problem.reason = reason;
  return problem;
}

}  // namespace object_modelling::nodes
