#include "view_image.h"

#include <opencv2/imgproc.hpp>

namespace object_modelling::texture
{
namespace
{
constexpr int MARGIN_PX = 4;
}

ViewImage correctedImage(const TextureView& view, const Eigen::Vector3f& gains)
{
  const cv::Mat& whole = view.frame->color_bgr;
  cv::Rect box = cv::boundingRect(view.rim_px > 0);
  const cv::Point shift(cvRound(view.color_offset_px.x()), cvRound(view.color_offset_px.y()));
  box = cv::Rect(box.x - MARGIN_PX + shift.x, box.y - MARGIN_PX + shift.y, box.width + 2 * MARGIN_PX,
                 box.height + 2 * MARGIN_PX) &
        cv::Rect({ 0, 0 }, whole.size());
  if (box.width < 2 || box.height < 2)
    box = { 0, 0, 2, 2 };
  ViewImage image;
  whole(box).convertTo(image.bgr, CV_32FC3);
  cv::multiply(image.bgr, cv::Scalar(gains[0], gains[1], gains[2]), image.bgr);
  image.corner_px = { static_cast<float>(box.x), static_cast<float>(box.y) };
  return image;
}

}  // namespace object_modelling::texture
