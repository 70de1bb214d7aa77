#include "object_modelling/rgbd/depth_units.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "object_modelling/base/status.h"

namespace object_modelling::rgbd
{
namespace
{
constexpr float MISSING = std::numeric_limits<float>::quiet_NaN();

void requireUnit(double unit_m)
{
  if (!(unit_m > 0 && std::isfinite(unit_m)))
    throw base::Error(base::StatusCode::BAD_INPUT,
                      "depth unit of " + std::to_string(unit_m) + " m: must be a positive number of metres");
}

cv::Mat fromUnits(const cv::Mat& depth, float unit_m)
{
  cv::Mat depth_m(depth.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v)
  {
    const auto* in = depth.ptr<std::uint16_t>(v);
    auto* out = depth_m.ptr<float>(v);
    for (int u = 0; u < depth.cols; ++u)
      out[u] = in[u] > 0 ? in[u] * unit_m : MISSING;
  }
  return depth_m;
}

cv::Mat fromMeters(const cv::Mat& depth)
{
  cv::Mat depth_m(depth.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v)
  {
    const auto* in = depth.ptr<float>(v);
    auto* out = depth_m.ptr<float>(v);
    for (int u = 0; u < depth.cols; ++u)
      out[u] = in[u] > 0 && in[u] <= std::numeric_limits<float>::max() ? in[u] : MISSING;
  }
  return depth_m;
}

}  // namespace

cv::Mat depthInMeters(const cv::Mat& depth, double unit_m)
{
  if (depth.type() == CV_32FC1)
    return fromMeters(depth);
  if (depth.type() != CV_16UC1)
    throw base::Error(base::StatusCode::BAD_INPUT, "depth image of OpenCV type " + cv::typeToString(depth.type()) +
                                                       ": must be CV_16UC1 (units) or CV_32FC1 (metres)");
  requireUnit(unit_m);
  return fromUnits(depth, static_cast<float>(unit_m));
}

cv::Mat depthAs16Bit(const cv::Mat& depth_m, double unit_m)
{
  if (depth_m.type() != CV_32FC1)
    throw base::Error(base::StatusCode::BAD_INPUT,
                      "depth image of OpenCV type " + cv::typeToString(depth_m.type()) + ": must be CV_32FC1 (metres)");
  requireUnit(unit_m);
  const auto per_meter = static_cast<float>(1.0 / unit_m);
  cv::Mat depth(depth_m.size(), CV_16UC1);
  for (int v = 0; v < depth.rows; ++v)
  {
    const auto* in = depth_m.ptr<float>(v);
    auto* out = depth.ptr<std::uint16_t>(v);
    for (int u = 0; u < depth.cols; ++u)
    {
      const float units = in[u] * per_meter + 0.5f;
      out[u] = units >= 1.0f && units < 65536.0f ? static_cast<std::uint16_t>(units) : 0;
    }
  }
  return depth;
}

}  // namespace object_modelling::rgbd
