#include "object_modelling/rgbd/depth_edges.h"

#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/options.h"

namespace object_modelling::rgbd
{
namespace
{
/// What the step from `z` to a neighbour's depth makes of the pixel. Written without branches: it runs four times per
/// pixel.
inline int classify(float z, float neighbor, float step_ratio)
{
  const int occluding = neighbor > z * (1 + step_ratio) ? OCCLUDING : NO_EDGE;
  const int occluded = z > neighbor * (1 + step_ratio) ? OCCLUDED : NO_EDGE;
  const int missing = neighbor == neighbor ? NO_EDGE : MISSING_DATA;
  return occluding | occluded | missing;
}

}  // namespace

std::vector<std::string> DepthEdgeOptions::violations() const
{
  base::OptionsCheck check("depth_edges");
  check.inRange("step_ratio", step_ratio, 1e-4, 1.0);
  return check.violations();
}

cv::Mat findDepthEdges(const Frame& frame, const DepthEdgeOptions& options)
{
  base::checked(options);
  const auto ratio = static_cast<float>(options.step_ratio);
  const cv::Mat& depth = frame.depth_m;
  cv::Mat edges(depth.size(), CV_8UC1);
  for (int v = 0; v < depth.rows; ++v)
  {
    // The rim compares with itself: the end of the image is not the end of a surface.
    const auto* row = depth.ptr<float>(v);
    const auto* above = depth.ptr<float>(std::max(v - 1, 0));
    const auto* below = depth.ptr<float>(std::min(v + 1, depth.rows - 1));
    auto* out = edges.ptr<std::uint8_t>(v);
    for (int u = 0; u < depth.cols; ++u)
    {
      const float z = row[u];
      const int kinds = classify(z, row[std::max(u - 1, 0)], ratio) |
                        classify(z, row[std::min(u + 1, depth.cols - 1)], ratio) | classify(z, above[u], ratio) |
                        classify(z, below[u], ratio);
      out[u] = static_cast<std::uint8_t>(z == z ? kinds : NO_EDGE);
    }
  }
  return edges;
}

cv::Mat distanceToEdges_px(const cv::Mat& edges, int kinds)
{
  cv::Mat away;
  cv::bitwise_and(edges, cv::Scalar(kinds), away);
  cv::compare(away, 0, away, cv::CMP_EQ);
  if (cv::countNonZero(away) == static_cast<int>(away.total()))
    return cv::Mat(edges.size(), CV_32FC1, cv::Scalar(edges.cols + edges.rows));
  cv::Mat distance_px;
  cv::distanceTransform(away, distance_px, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance_px;
}

}  // namespace object_modelling::rgbd
