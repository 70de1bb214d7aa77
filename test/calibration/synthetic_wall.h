#pragma once

#include <random>
#include <vector>

#include "object_modelling/source/frame_source.h"

namespace object_modelling::calibration
{
/// How a flat rectangle of 1.8 x 1.4 m, a metre before a background, is seen in one frame.
struct WallPose
{
  double distance_m = 1;  ///< along the optical axis
  double tilt_rad = 0;    ///< about the image's vertical
};

/// Recording of a wall by a sensor whose noise is the given model's, bias and distortion included.
struct SyntheticWall
{
  rgbd::SensorNoiseModel sensor;
  std::vector<WallPose> poses;
  double missing_ratio = 0;  ///< of the pixels
  double outlier_ratio = 0;  ///< of the pixels: anywhere within half a metre
  double clutter_ratio = 0;  ///< share of the image's width that shows a sphere-like thing before the wall
  std::uint64_t seed = 1;
};

/// Distances and angles as somebody records them who steps back and forth before a door.
std::vector<WallPose> walk(double nearest_m, double farthest_m, double widest_rad, int count);

class SyntheticWallSource : public source::FrameSource
{
public:
  explicit SyntheticWallSource(SyntheticWall wall) : wall_(std::move(wall)), random_(wall_.seed) {}
  std::optional<rgbd::RawFrame> next() override;
  std::optional<std::size_t> size() const override { return wall_.poses.size(); }
  std::string frameId() const override { return "camera"; }
  std::string name() const override { return "synthetic wall"; }

private:
  SyntheticWall wall_;
  std::mt19937_64 random_;
  std::size_t next_ = 0;
};

}  // namespace object_modelling::calibration
