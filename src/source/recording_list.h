#pragma once

#include <string>
#include <vector>

namespace object_modelling::source
{
/// Colour and depth image of one instant, and its mask if there is one. Full paths.
struct RecordedFrame
{
  double stamp_s = 0;
  double depth_stamp_s = 0;
  std::string color_path;
  std::string depth_path;
  std::string mask_path;  ///< empty if none
};

/// Frames of a TUM-style folder in the order of their stamps: from associations.txt where there is one, else by pairing
/// rgb.txt and depth.txt. Throws base::Error as openTumFolder.
std::vector<RecordedFrame> readRecordingList(const std::string& folder, double max_stamp_difference_s);

/// Fills in the masks that mask.txt lists with exactly a frame's stamp; nothing to do if there is no mask.txt.
void addMasks(const std::string& folder, std::vector<RecordedFrame>* frames);

}  // namespace object_modelling::source
