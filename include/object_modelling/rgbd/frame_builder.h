#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "object_modelling/base/status.h"
#include "object_modelling/rgbd/frame.h"

namespace object_modelling::rgbd
{
/// What a sensor or file delivers for one instant, before any check.
struct RawFrame
{
  double stamp_s = 0;
  double depth_stamp_s = 0;
  cv::Mat color;  ///< CV_8UC3 BGR or CV_8UC1 gray
  cv::Mat depth;  ///< CV_16UC1 in depth_unit_m, or CV_32FC1 in metres
  double depth_unit_m = 0.001;
  cv::Mat object_mask;             ///< CV_8UC1, > 0 on the object; may be empty
  geometry::PinholeCamera camera;  ///< of the colour image, with its distortion
};

struct FrameBuilderOptions
{
  double max_stamp_difference_s = 0.02;  ///< colour and depth further apart than this are not one frame
  double min_depth_ratio = 0.001;        ///< share of pixels that must have depth
  double min_depth_m = 0.1;              ///< nearer or farther readings count as missing
  double max_depth_m = 8.0;
  SensorNoiseModel noise_model;  ///< copied to every frame; its bias and colour offset are removed
  std::vector<std::string> violations() const;
};

/// Checks a raw frame and makes a Frame of it: depth in metres, without the noise model's bias, both images rectified
/// and colour shifted onto depth by its offset (colour bilinear, depth and mask nearest neighbour) through maps that
/// are computed once per camera. Not thread safe.
class FrameBuilder
{
public:
  explicit FrameBuilder(const FrameBuilderOptions& options = {});

  /// BAD_INPUT names what is wrong and with which values: empty images, colour and depth of different size, camera of
  /// another size, unusable intrinsics, stamps apart, no depth at all, encodings.
  base::Result<Frame> build(const RawFrame& raw);

private:
  struct Images
  {
    cv::Mat color, depth, object_mask;
  };

  Images rectified(const RawFrame& raw);
  void updateMaps(const geometry::PinholeCamera& camera);
  void takeBiasOff(cv::Mat* depth_m);

  FrameBuilderOptions options_;
  geometry::PinholeCamera mapped_camera_;  ///< camera of the maps; none yet if its width is 0
  cv::Mat color_map_, color_map_fraction_;
  cv::Mat nearest_map_;
  /// What linear bias and distortion leave of depth: CV_32FC1, of the frames' size; empty until needed.
  cv::Mat unbiased_share_;
};

}  // namespace object_modelling::rgbd
