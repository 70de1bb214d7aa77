#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include <object_modelling/TrackingState.h>

#include "../common/frame_pairer.h"
#include "camera_tracker_options.h"
#include "object_modelling/pipeline/session_recorder.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "robot_motion.h"
#include "session_record.h"

namespace object_modelling::nodes
{
/// What became of one frame.
struct TrackedFrame
{
  object_modelling::TrackingState state;
  std::optional<rgbd::Frame> frame;                ///< if its messages could be used
  std::optional<tracking::TrackingResult> result;  ///< if it was given to the tracker
};

/// Between ~start and ~stop: messages into the recorder of a session, and its state out. Thread safe: services and
/// frames come from different threads. Throws base::Error where it refuses.
class Recording
{
public:
  /// `record` must outlive this.
  Recording(const CameraTrackerNodeOptions& options, SessionRecord& record);

  /// Gives the id of the session that begins; an empty one is made from `now`.
  std::string start(const std::string& session_id, const std::string& object_id, bool resume, const ros::Time& now);
  /// Ends the session; returns its last state. `stored`: OK if all of it has been stored.
  object_modelling::TrackingState stop(base::Status* stored);
  /// Back to idle; gives the id of the session that was left, or nothing.
  std::string reset();

  /// `dropped_count`: frames lost before this one. A problem with the robot's pose is reported once.
  TrackedFrame process(const FrameMessages& messages, std::size_t dropped_count, const RobotPose& robot);
  /// State without a frame.
  object_modelling::TrackingState state(const ros::Time& now);
  /// The same for an input problem.
  object_modelling::TrackingState inputProblem(const std::string& reason, const ros::Time& now);

private:
  rgbd::Frame frameOf(const FrameMessages& messages);
  void record(const std_msgs::Header& header, const RobotPose& robot, TrackedFrame* tracked);
  void say(const RobotPose& robot, std::string* reason);
  void setLost();
  void count(object_modelling::TrackingState* state) const;

  std::mutex mutex_;
  CameraTrackerNodeOptions options_;
  SessionRecord& record_;
  rgbd::FrameBuilder builder_;
  pipeline::SessionRecorder recorder_;
  tracking::TrackingStatus status_ = tracking::TrackingStatus::NOT_STARTED;
  bool input_ok_ = false;
  int dropped_frames_ = 0;     ///< of the session
  std::string robot_problem_;  ///< reported, and not gone since
};

}  // namespace object_modelling::nodes
