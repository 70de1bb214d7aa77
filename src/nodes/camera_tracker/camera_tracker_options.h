#pragma once

#include <string>
#include <vector>

#include "../common/frame_parameters.h"
#include "../common/store_parameters.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/ros_bridge/remote_session_store.h"
#include "object_modelling/segmentation/object_follower.h"
#include "object_modelling/tracking/camera_tracker.h"

namespace object_modelling::nodes
{
enum class TfDirection
{
  SESSION_BELOW_CAMERA,  ///< parent: camera frame; a robot's own tree keeps one parent per frame
  CAMERA_BELOW_SESSION,  ///< parent: session frame; for a camera that is in no other tree
  NONE,
};

enum class MaskSource
{
  AUTO,   ///< the topic if somebody publishes it, else own
  TOPIC,  ///< object_mask
  OWN,    ///< the node finds the object itself
};

/// A robot that carries the camera.
struct RobotOptions
{
  std::string frame_id;   ///< frame that stands still with respect to what is tracked; empty: no robot
  double wait_s = 0.005;  ///< for tf of a frame's time
};

struct CameraTrackerNodeOptions
{
  tracking::CameraTrackerOptions tracker;
  rgbd::FrameBuilderOptions frame;
  segmentation::ObjectFollowerOptions follower;
  MaskSource mask_source = MaskSource::AUTO;
  RobotOptions robot;
  ros_bridge::RemoteSessionStoreOptions store;
  bool use_store = true;  ///< sessions and keyframes go to the keyframe store; false: keyframes are published only
  double stored_timeout_s = 20;  ///< how long ~stop waits for the store to have all keyframes
  std::string session_frame_id = "session";
  TfDirection tf_direction = TfDirection::SESSION_BELOW_CAMERA;
  double input_timeout_s = 3;      ///< a topic that is silent for longer is reported in ~state
  bool require_registered = true;  ///< refuse depth whose frame_id is not that of colour
  std::vector<std::string> violations() const;
};

template <typename Reader>
void read(Reader& reader, CameraTrackerNodeOptions* options)
{
  reader.read("reference", options->tracker.reference,
              { { "scene", tracking::Reference::SCENE }, { "object", tracking::Reference::OBJECT } });
  reader.read("tracker/max_features", options->tracker.max_features);
  reader.read("tracker/min_inliers", options->tracker.min_inliers);
  reader.read("tracker/min_inlier_ratio", options->tracker.min_inlier_ratio);
  reader.read("tracker/max_reprojection_error_px", options->tracker.max_reprojection_error_px);
  reader.read("tracker/keyframe_angle_rad", options->tracker.keyframe_angle_rad);
  reader.read("tracker/keyframe_distance_ratio", options->tracker.keyframe_distance_ratio);
  reader.read("tracker/seed", options->tracker.seed);
  reader.read("object/mask_source", options->mask_source,
              { { "auto", MaskSource::AUTO }, { "topic", MaskSource::TOPIC }, { "own", MaskSource::OWN } });
  reader.read("object/max_turntable_size_m", options->follower.max_turntable_size_m);
  reader.read("robot/frame_id", options->robot.frame_id);
  reader.read("robot/translation_sigma_m", options->tracker.robot_translation_sigma_m);
  reader.read("robot/rotation_sigma_rad", options->tracker.robot_rotation_sigma_rad);
  reader.read("robot/wait_s", options->robot.wait_s);
  read(reader, &options->frame);
  reader.read("use_store", options->use_store);
  reader.read("stored_timeout_s", options->stored_timeout_s);
  reader.read("session_frame_id", options->session_frame_id);
  reader.read("tf_direction", options->tf_direction,
              { { "session_below_camera", TfDirection::SESSION_BELOW_CAMERA },
                { "camera_below_session", TfDirection::CAMERA_BELOW_SESSION },
                { "none", TfDirection::NONE } });
  reader.read("input_timeout_s", options->input_timeout_s);
  reader.read("require_registered", options->require_registered);
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
