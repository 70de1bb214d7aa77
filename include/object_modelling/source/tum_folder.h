#pragma once

#include <memory>
#include <string>
#include <vector>

#include "object_modelling/source/frame_source.h"

namespace object_modelling::source
{
struct TumFolderOptions
{
  double max_stamp_difference_s = 0.02;  ///< pairing of rgb.txt and depth.txt where associations.txt is missing
  bool decode_ahead = true;              ///< the next frame in another thread; off where the time of others is measured
  bool use_masks = true;                 ///< deliver mask/ (listed in mask.txt, exact stamps) as object masks
  std::vector<std::string> violations() const;
};

/// TUM-style folder: rgb.txt and depth.txt ("stamp path" lines, '#' comments) or associations.txt, and camera.yaml with
/// width, height, fx, fy, cx, cy, distortion, depth_scale (metres per unit), optional frame_id. In mask images any
/// value > 0 is the object, unless mask.txt has instances (objects.yaml): then `instance` 1.
/// Frames come in the order of their stamps, which must differ.
/// Throws base::Error: NOT_FOUND for missing files, BAD_INPUT with file and line for malformed ones; a path that leaves
/// the folder is refused.
std::unique_ptr<FrameSource> openTumFolder(const std::string& folder, const TumFolderOptions& options = {});

}  // namespace object_modelling::source
