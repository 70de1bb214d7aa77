#include "low_holes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/statistics.h"

namespace object_modelling::segmentation
{
namespace
{
constexpr std::size_t MIN_HOLE_PX = 20;  // the median of fewer heights is noise

struct Hole
{
  std::vector<float> heights_m;
  bool open = false;  // reaches the border of the rectangle: not enclosed
  bool low_object = false;
};

}  // namespace

void fillLowHoles(const rgbd::Frame& frame, const geometry::Plane& plane_camera, double min_height_m,
                  double max_height_m, const cv::Rect& rect, cv::Mat* mask)
{
  cv::Mat labels;
  const int label_count = cv::connectedComponents((*mask)(rect) == 0, labels, 4, CV_32S);
  std::vector<Hole> holes(label_count);
  holes[0].open = true;  // the mask itself
  const auto height_m = [&](int u, int v)
  { return plane_camera.signedDistance_m(frame.point(rect.x + u, rect.y + v).cast<double>()); };
  for (int v = 0; v < rect.height; ++v)
    for (int u = 0; u < rect.width; ++u)
      if (u == 0 || v == 0 || u == rect.width - 1 || v == rect.height - 1)
        holes[labels.at<int>(v, u)].open = true;
  for (int v = 0; v < rect.height; ++v)
    for (int u = 0; u < rect.width; ++u)
    {
      Hole& hole = holes[labels.at<int>(v, u)];
      if (hole.open)
        continue;
      const double h_m = height_m(u, v);
      if (std::isfinite(h_m))
        hole.heights_m.push_back(static_cast<float>(h_m));
    }
  for (Hole& hole : holes)
  {
    if (hole.heights_m.size() < MIN_HOLE_PX)
      continue;
    const float median_height_m = base::median(&hole.heights_m);
    hole.low_object = median_height_m > min_height_m / 2 && median_height_m <= max_height_m;
  }
  for (int v = 0; v < rect.height; ++v)
    for (int u = 0; u < rect.width; ++u)
    {
      if (!holes[labels.at<int>(v, u)].low_object)
        continue;
      if (height_m(u, v) <= max_height_m)  // false for missing depth
        mask->at<std::uint8_t>(rect.y + v, rect.x + u) = 255;
    }
}

}  // namespace object_modelling::segmentation
