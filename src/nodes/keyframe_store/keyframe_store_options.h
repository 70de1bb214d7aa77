#pragma once

#include <string>
#include <vector>

#include "object_modelling/ros_bridge/param_reader.h"
#include "session_preview.h"

namespace object_modelling::nodes
{
struct KeyframeStoreOptions
{
  /// SQLite file ("~/" stands for the home folder) or "postgresql://..."; empty: keyframes.sqlite in the folder
  /// object_modelling of ROS_HOME (~/.ros).
  std::string store_path;
  std::string session_frame_id = "session";  ///< frame of the previews
  double preview_rate_hz = 2;                ///< previews are published at most this often
  SessionPreviewOptions preview;
  std::vector<std::string> violations() const;
};

KeyframeStoreOptions readKeyframeStoreOptions(ros_bridge::ParamReader& reader);

/// The connection for openSqlStore, with home folder and default filled in.
std::string storeConnection(const std::string& store_path);

}  // namespace object_modelling::nodes
