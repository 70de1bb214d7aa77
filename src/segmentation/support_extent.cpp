#include "support_extent.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace object_modelling::segmentation
{
SupportExtent::SupportExtent(const WorkingImage& image, const GrownPlanes& planes, int index)
{
  const Eigen::Vector3d& n = planes.planes[index].plane.normal;
  x_axis_ = n.unitOrthogonal();
  y_axis_ = n.cross(x_axis_);
  // Seen from one side a plane's convex outline is the convex outline of its image: the ends of the rows suffice.
  std::vector<cv::Point2f> ends;
  for (int v = 0; v < planes.labels.rows; ++v)
  {
    const auto* row = planes.labels.ptr<std::int16_t>(v);
    int left = 0, right = planes.labels.cols - 1;
    while (left <= right && row[left] != index)
      ++left;
    while (right > left && row[right] != index)
      --right;
    if (left > right)
      continue;
    ends.push_back(onPlane(image.frame.point(left, v).cast<double>()));
    ends.push_back(onPlane(image.frame.point(right, v).cast<double>()));
  }
  if (!ends.empty())
    cv::convexHull(ends, outline_);
}

cv::Point2f SupportExtent::onPlane(const Eigen::Vector3d& p_camera) const
{
  return { static_cast<float>(x_axis_.dot(p_camera)), static_cast<float>(y_axis_.dot(p_camera)) };
}

bool SupportExtent::carries(const Eigen::Vector3d& p_camera, double margin_m) const
{
  return outline_.size() >= 3 && cv::pointPolygonTest(outline_, onPlane(p_camera), true) >= -margin_m;
}

double SupportExtent::carriedRatio(const rgbd::Frame& frame, const cv::Mat& mask, const cv::Rect& rect,
                                   double margin_m) const
{
  constexpr double SAMPLES = 400;
  const int stride = std::max(1, static_cast<int>(std::sqrt(rect.area() / SAMPLES)));
  int seen = 0, carried = 0;
  for (int v = rect.y; v < rect.y + rect.height; v += stride)
    for (int u = rect.x; u < rect.x + rect.width; u += stride)
      if (mask.at<std::uint8_t>(v, u) != 0)
      {
        ++seen;
        carried += carries(frame.point(u, v).cast<double>(), margin_m);
      }
  return seen > 0 ? static_cast<double>(carried) / seen : 0;
}

}  // namespace object_modelling::segmentation
