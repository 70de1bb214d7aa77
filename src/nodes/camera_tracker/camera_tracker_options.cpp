#include "camera_tracker_options.h"

#include "object_modelling/base/options.h"

namespace object_modelling::nodes
{
std::vector<std::string> CameraTrackerNodeOptions::violations() const
{
  base::OptionsCheck check("camera_tracker");
  check.inRange("stored_timeout_s", stored_timeout_s, 0.1, 600.0);
  check.inRange("input_timeout_s", input_timeout_s, 0.1, 600.0);
  check.require("session_frame_id", !session_frame_id.empty() && session_frame_id.front() != '/',
                "must be a frame id without leading slash");
  check.include(tracker.violations());
  check.include(frame.violations());
  return check.violations();
}

}  // namespace object_modelling::nodes
