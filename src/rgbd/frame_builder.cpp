#include "object_modelling/rgbd/frame_builder.h"

#include <cmath>
#include <limits>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "object_modelling/base/options.h"
#include "object_modelling/rgbd/depth_units.h"

namespace object_modelling::rgbd
{
namespace
{
std::string text(const cv::Size& size)
{
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// What makes the frame unusable whatever its pixels; empty if nothing does.
std::string defect(const RawFrame& raw, const FrameBuilderOptions& options)
{
  const cv::Size camera_size(raw.camera.width, raw.camera.height);
  if (raw.color.empty())
    return "colour image is empty";
  if (raw.depth.empty())
    return "depth image is empty";
  if (raw.color.type() != CV_8UC3 && raw.color.type() != CV_8UC1)
    return "colour image of OpenCV type " + cv::typeToString(raw.color.type()) + ": must be CV_8UC3 or CV_8UC1";
  if (raw.depth.type() != CV_16UC1 && raw.depth.type() != CV_32FC1)
    return "depth image of OpenCV type " + cv::typeToString(raw.depth.type()) +
           ": must be CV_16UC1 (units) or CV_32FC1 (metres)";
  if (raw.depth.type() == CV_16UC1 && !(raw.depth_unit_m > 0 && std::isfinite(raw.depth_unit_m)))
    return "depth unit of " + std::to_string(raw.depth_unit_m) + " m: must be a positive number of metres";
  if (raw.depth.size() != raw.color.size())
    return "depth image is " + text(raw.depth.size()) + ", colour image " + text(raw.color.size()) +
           ": register depth to colour";
  const std::vector<std::string> violations = raw.camera.violations();
  if (!violations.empty())
    return "unusable intrinsics: " + violations.front();
  if (raw.color.size() != camera_size)
    return "colour image is " + text(raw.color.size()) + ", its camera info " + text(camera_size);
  if (!raw.object_mask.empty() && (raw.object_mask.type() != CV_8UC1 || raw.object_mask.size() != raw.color.size()))
    return "object mask is " + text(raw.object_mask.size()) + " of OpenCV type " +
           cv::typeToString(raw.object_mask.type()) + ": must be CV_8UC1 of the colour image's size";
  // The rounding of stamps around 1e9 s is below a microsecond.
  const double apart_s = std::abs(raw.stamp_s - raw.depth_stamp_s);
  if (!(apart_s <= options.max_stamp_difference_s + 1e-6))
    return "colour and depth are " + std::to_string(apart_s) + " s apart, allowed are " +
           std::to_string(options.max_stamp_difference_s) + " s (max_stamp_difference_s)";
  return {};
}

/// Marks depth out of range as missing and counts the rest.
std::size_t clip(float min_m, float max_m, cv::Mat* depth_m)
{
  std::size_t count = 0;
  for (int v = 0; v < depth_m->rows; ++v)
  {
    auto* row = depth_m->ptr<float>(v);
    int row_count = 0;
    for (int u = 0; u < depth_m->cols; ++u)
    {
      const bool usable = row[u] >= min_m && row[u] <= max_m;
      row[u] = usable ? row[u] : std::numeric_limits<float>::quiet_NaN();
      row_count += usable ? 1 : 0;
    }
    count += static_cast<std::size_t>(row_count);
  }
  return count;
}

base::Status badInput(const std::string& message)
{
  return { base::StatusCode::BAD_INPUT, message };
}

}  // namespace

std::vector<std::string> FrameBuilderOptions::violations() const
{
  base::OptionsCheck check("frame_builder");
  check.atLeast("max_stamp_difference_s", max_stamp_difference_s, 0.0);
  check.inRange("min_depth_ratio", min_depth_ratio, 0.0, 1.0);
  check.atLeast("min_depth_m", min_depth_m, 0.0);
  check.require("max_depth_m", max_depth_m > min_depth_m, "must be greater than min_depth_m");
  check.include(noise_model.violations());
  return check.violations();
}

FrameBuilder::FrameBuilder(const FrameBuilderOptions& options) : options_(base::checked(options))
{
}

void FrameBuilder::updateMaps(const geometry::PinholeCamera& camera)
{
  if (mapped_camera_ == camera)
    return;
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Matx33d shifted = K;  // with it a pixel of the result shows what the colour image has that offset farther
  shifted(0, 2) -= options_.noise_model.color_offset_x_px;
  shifted(1, 2) -= options_.noise_model.color_offset_y_px;
  const cv::Size size(camera.width, camera.height);
  cv::Mat map_x;
  cv::Mat map_y;
  cv::initUndistortRectifyMap(K, camera.distortion, cv::noArray(), shifted, size, CV_32FC1, map_x, map_y);
  cv::convertMaps(map_x, map_y, color_map_, color_map_fraction_, CV_16SC2);
  // A map of its own, rounded: nearest neighbour by the colour map would cut the fraction off, half a pixel too low.
  cv::initUndistortRectifyMap(K, camera.distortion, cv::noArray(), K, size, CV_32FC1, map_x, map_y);
  cv::Mat unused;
  cv::convertMaps(map_x, map_y, nearest_map_, unused, CV_16SC2, true);
  mapped_camera_ = camera;
}

FrameBuilder::Images FrameBuilder::rectified(const RawFrame& raw)
{
  const bool distorted = raw.camera.distorted();
  Images images{ raw.color, raw.depth, raw.object_mask };
  if (!distorted && !options_.noise_model.shiftsColor())
    return images;
  updateMaps(raw.camera);
  images.color = cv::Mat();
  const int border = distorted ? cv::BORDER_CONSTANT : cv::BORDER_REPLICATE;
  cv::remap(raw.color, images.color, color_map_, color_map_fraction_, cv::INTER_LINEAR, border);
  if (!distorted)
    return images;
  // Out of the image is 0, which is "missing" in both depth types and "not the object" in the mask.
  images.depth = images.object_mask = cv::Mat();
  cv::remap(raw.depth, images.depth, nearest_map_, cv::noArray(), cv::INTER_NEAREST);
  if (!raw.object_mask.empty())
    cv::remap(raw.object_mask, images.object_mask, nearest_map_, cv::noArray(), cv::INTER_NEAREST);
  return images;
}

void FrameBuilder::takeBiasOff(cv::Mat* depth_m)
{
  const SensorNoiseModel& model = options_.noise_model;
  if (!model.correctsDepth())
    return;
  if (unbiased_share_.size() != depth_m->size())
    unbiased_share_ =
        1 - model.depth_bias_linear_ratio - DistortionGrid::image(model.depth_distortion_ratio, depth_m->size());
  const auto constant_m = static_cast<float>(model.depth_bias_constant_m);
  const auto quadratic_per_m = static_cast<float>(model.depth_bias_quadratic_per_m);
  for (int v = 0; v < depth_m->rows; ++v)
  {
    auto* row = depth_m->ptr<float>(v);
    const auto* share = unbiased_share_.ptr<float>(v);
    for (int u = 0; u < depth_m->cols; ++u)
      row[u] = row[u] * (share[u] - quadratic_per_m * row[u]) - constant_m;
  }
}

base::Result<Frame> FrameBuilder::build(const RawFrame& raw)
{
  base::Result<Frame> result;
  const std::string reason = defect(raw, options_);
  if (!reason.empty())
  {
    result.status = badInput(reason);
    return result;
  }
  const Images images = rectified(raw);

  Frame& frame = result.value;
  frame.stamp_s = raw.stamp_s;
  frame.depth_delay_s = raw.depth_stamp_s - raw.stamp_s;
  frame.camera = raw.camera;
  frame.camera.distortion.clear();
  frame.noise_model = options_.noise_model;
  frame.depth_m = depthInMeters(images.depth, raw.depth_unit_m);
  takeBiasOff(&frame.depth_m);
  const std::size_t count =
      clip(static_cast<float>(options_.min_depth_m), static_cast<float>(options_.max_depth_m), &frame.depth_m);
  const double ratio = static_cast<double>(count) / static_cast<double>(frame.depth_m.total());
  if (count == 0 || ratio < options_.min_depth_ratio)
  {
    result.status = badInput("only " + std::to_string(count) + " of " + std::to_string(frame.depth_m.total()) +
                             " pixels have depth between " + std::to_string(options_.min_depth_m) + " and " +
                             std::to_string(options_.max_depth_m) + " m: is the camera covered or too close?");
    return result;
  }
  if (images.color.channels() == 3)
  {
    frame.color_bgr = images.color;
    cv::cvtColor(images.color, frame.gray, cv::COLOR_BGR2GRAY);
  }
  else
  {
    frame.gray = images.color;
    cv::cvtColor(images.color, frame.color_bgr, cv::COLOR_GRAY2BGR);
  }
  if (!images.object_mask.empty())
    cv::compare(images.object_mask, 0, frame.object_mask, cv::CMP_GT);
  return result;
}

}  // namespace object_modelling::rgbd
