#include "object_modelling/rgbd/color_shift.h"

#include <opencv2/imgproc.hpp>

namespace object_modelling::rgbd
{
cv::Mat ontoDepth(const cv::Mat& gray, const Eigen::Vector2d& color_offset_px)
{
  constexpr double NO_OFFSET_PX = 0.01;
  if (color_offset_px.norm() < NO_OFFSET_PX)
    return gray;
  const cv::Matx23d shift(1, 0, color_offset_px.x(), 0, 1, color_offset_px.y());
  cv::Mat shifted;
  cv::warpAffine(gray, shifted, shift, gray.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return shifted;
}

}  // namespace object_modelling::rgbd
