#include "camera_tracker_options.h"

#include "../common/frame_parameters.h"

namespace object_modelling::nodes
{
std::vector<std::string> CameraTrackerNodeOptions::violations() const
{
  base::OptionsCheck check("camera_tracker");
  check.inRange("stored_timeout_s", stored_timeout_s, 0.1, 600.0);
  check.inRange("input_timeout_s", input_timeout_s, 0.1, 600.0);
  requireFrameId(check, "session_frame_id", session_frame_id);
  if (!robot.frame_id.empty())
  {
    check.require("robot/frame_id", robot.frame_id != session_frame_id,
                  "must not be session_frame_id, '" + session_frame_id +
                      "': that is what this node estimates; name a frame of the robot that does not move, its base");
    requireFrameId(check, "robot/frame_id", robot.frame_id);
    check.require("tf_direction", tf_direction != TfDirection::CAMERA_BELOW_SESSION,
                  "must not be camera_below_session where robot/frame_id is set: the camera hangs below the robot");
  }
  check.inRange("robot/wait_s", robot.wait_s, 0.0, 0.1);
  check.include(follower.violations());
  check.include(tracker.violations());
  check.include(frame.violations());
  return check.violations();
}

}  // namespace object_modelling::nodes
