#pragma once

#include <opencv2/core.hpp>

namespace object_modelling::segmentation
{
/// Whether what carries an object moves when the object does: a turntable, or a tray on which somebody turns the
/// object. Compares the image with an earlier one, without a known motion. Not thread safe.
class JointMotion
{
public:
  /// The next frame (CV_8UC1 grey image and masks). False from when the object has changed in the image while the
  /// carrier looks as before, until both change.
  bool together(const cv::Mat& gray, const cv::Mat& object, const cv::Mat& carrier);

private:
  cv::Mat gray_, object_, carrier_;  ///< of the earlier image, thinned
  int age_ = 0;
  int apart_count_ = 0;
  bool together_ = true;
};

}  // namespace object_modelling::segmentation
