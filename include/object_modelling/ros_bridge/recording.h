#pragma once

#include <memory>
#include <string>
#include <vector>

#include "object_modelling/ros_bridge/bag_source.h"
#include "object_modelling/source/tum_folder.h"

namespace object_modelling::ros_bridge
{
struct RecordingOptions
{
  source::TumFolderOptions folder;
  BagSourceOptions bag;
};

/// Opens a recording by what it is: a TUM-style folder or a ROS bag. Throws base::Error: NOT_FOUND for a missing path,
/// BAD_INPUT for anything else, naming what can be read, and as openTumFolder and openBag do.
std::unique_ptr<source::FrameSource> openRecording(const std::string& path, const RecordingOptions& options = {});

}  // namespace object_modelling::ros_bridge
