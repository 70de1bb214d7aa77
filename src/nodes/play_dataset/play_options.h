#pragma once

#include <string>

#include "object_modelling/ros_bridge/recording.h"

namespace object_modelling::nodes
{
struct PlayOptions
{
  std::string recording;
  double rate_ratio = 1;  ///< of the speed at which it was recorded
  bool lossless = false;  ///< next frame when the tracker has answered for the one before
  bool loop = false;
  double wait_s = 10;            ///< how long to wait for listeners before the first frame
  double answer_timeout_s = 10;  ///< lossless: how long the tracker may take for one frame
  std::string tracker_state = "camera_tracker/state";
  ros_bridge::RecordingOptions source;
};

/// Reads the command line (without ROS' own arguments). On --help or a mistake it prints the help or error and returns
/// false with the exit code.
bool parseCommandLine(int argc, char** argv, PlayOptions* options, int* exit_code);

}  // namespace object_modelling::nodes
