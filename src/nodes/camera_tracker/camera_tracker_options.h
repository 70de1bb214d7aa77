#pragma once

#include <string>
#include <vector>

#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/ros_bridge/param_reader.h"
#include "object_modelling/ros_bridge/remote_session_store.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::nodes
{
enum class TfDirection
{
  SESSION_BELOW_CAMERA,  ///< parent: camera frame; a robot's own tree keeps one parent per frame
  CAMERA_BELOW_SESSION,  ///< parent: session frame; for a camera that is in no other tree
  NONE,
};

struct CameraTrackerNodeOptions
{
  tracking::CameraTrackerOptions tracker;
  rgbd::FrameBuilderOptions frame;
  ros_bridge::RemoteSessionStoreOptions store;
  bool use_store = true;  ///< sessions and keyframes go to the keyframe store; false: keyframes are published only
  double stored_timeout_s = 20;  ///< how long ~stop waits for the store to have all keyframes
  std::string session_frame_id = "session";
  TfDirection tf_direction = TfDirection::SESSION_BELOW_CAMERA;
  double input_timeout_s = 3;       ///< a topic that is silent for longer is reported in ~state
  bool require_registered = true;   ///< refuse depth whose frame_id is not that of colour
  std::vector<std::string> violations() const;
};

CameraTrackerNodeOptions readCameraTrackerOptions(ros_bridge::ParamReader& reader);

}  // namespace object_modelling::nodes
