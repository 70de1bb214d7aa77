#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include <object_modelling/TrackingState.h>

#include "camera_tracker_options.h"
#include "frame_pairer.h"
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

/// Between ~start and ~stop: the tracker and the session that it records. Thread safe: services and frames come from
/// different threads. Throws base::Error where it refuses.
class Recording
{
public:
  /// `record` may be null: then nothing is stored. It must outlive this.
  Recording(const CameraTrackerNodeOptions& options, SessionRecord* record);

  /// Gives the id of the session that begins; an empty one is made from `now`.
  std::string start(const std::string& session_id, const std::string& object_id, bool resume, const ros::Time& now);
  /// Ends the session; the state tells of it, the status whether all of it has been stored.
  object_modelling::TrackingState stop(base::Status* stored);
  /// Back to idle; gives the id of the session that was left, or nothing.
  std::string reset();

  /// `dropped_count`: frames lost before this one. What is wrong with the robot's pose is said once.
  TrackedFrame process(const FrameMessages& messages, std::size_t dropped_count, const RobotPose& robot);
  /// State when there is no frame to tell of.
  object_modelling::TrackingState state(const ros::Time& now);
  /// The same for an input problem.
  object_modelling::TrackingState inputProblem(const std::string& reason, const ros::Time& now);

private:
  rgbd::Frame frameOf(const FrameMessages& messages);
  void track(const std_msgs::Header& header, const RobotPose& robot, TrackedFrame* tracked);
  void requireNewer(const ros::Time& stamp);
  void say(const RobotPose& robot, std::string* reason);
  void createSession(const std_msgs::Header& header);

  std::mutex mutex_;
  CameraTrackerNodeOptions options_;
  SessionRecord* record_;
  rgbd::FrameBuilder builder_;
  segmentation::ObjectFollower follower_;
  tracking::CameraTracker tracker_;
  keyframes::Session session_;
  bool created_ = false;  ///< the session is in the store, or need not be
  int sent_keyframes_ = 0;
  ros::Time last_stamp_;                   ///< of the session; 0 before its first frame
  std::string robot_problem_;              ///< that has been said and has not gone since
  object_modelling::TrackingState state_;  ///< running counts; what a frame says is filled in a copy
};

}  // namespace object_modelling::nodes
