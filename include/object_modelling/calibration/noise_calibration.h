#pragma once

#include <map>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/sensor_noise_model.h"
#include "object_modelling/source/frame_source.h"

namespace object_modelling::calibration
{
struct NoiseCalibrationOptions
{
  rgbd::FrameBuilderOptions frame;      ///< its noise model is not used: raw depth is measured
  double min_wall_ratio = 0.3;          ///< of the pixels with depth that must lie on one plane, or a frame is not used
  int min_frames = 10;                  ///< fewer usable ones are no calibration
  int min_blocks_per_bin = 10;          ///< a bin of distance and angle with fewer blocks does not count
  double min_distance_span_m = 0.5;     ///< between the bins, or the growth with distance keeps its default
  double grazing_from_rad = 1.1344640;  ///< 65 deg: the grazing term is fitted to what is seen at larger angles
  std::vector<std::string> violations() const;
};

/// Shortest distance from the optical centre to the wall, measured by other means.
struct MeasuredDistance
{
  double stamp_s = 0;
  double distance_m = 0;
};

/// Standard deviation of depth within one range of distance and angle.
struct NoiseBin
{
  double z_m = 0, theta_rad = 0;  ///< means of what is in it
  int block_count = 0;
  double sigma_m = 0;         ///< measured: median of the blocks
  double fitted_sigma_m = 0;  ///< of the result's model
};

/// Lateral standard deviation of the straight rims within one range of angle.
struct LateralBin
{
  double theta_rad = 0;
  int edge_count = 0;
  double length_px = 0;  ///< of the edges together
  double sigma_px = 0;   ///< measured: width of the frayed step
};

/// What became of one coefficient (or a group of them).
struct CoefficientReport
{
  std::string name;
  bool fitted = false;
  std::string reason;  ///< what it was fitted to, or why it has its default
};

struct NoiseCalibration
{
  base::Status status;  ///< NO_RESULT: too little to fit anything; the message says what was wrong with the frames
  rgbd::SensorNoiseModel model;
  std::vector<CoefficientReport> coefficients;
  int frame_count = 0, used_count = 0;
  std::map<std::string, int> unused;  ///< number of frames that were not used, by reason
  double min_z_m = 0, max_z_m = 0, min_theta_rad = 0, max_theta_rad = 0;  ///< of the blocks measured
  std::vector<NoiseBin> bins;                                             ///< by distance, then angle
  std::vector<LateralBin> lateral_bins;                                   ///< by angle
  int edge_count = 0;                ///< straight edges that the lateral sigma comes from
  double flatness_before_ratio = 0;  ///< RMS of smooth deviations from the planes, as a share of depth ...
  double flatness_after_ratio = 0;   ///< ... and with the distortion taken off, in frames that it was not fitted to
};

/// Measures a depth sensor on a recording of a flat wall or door, seen from several distances and angles. Per frame a
/// plane is fitted robustly to inverse depth. In blocks of 32 x 32 px, what is left about a plane of their own is axial
/// noise; the offsets of these from the frame's plane are smooth distortion. The wall's straight rim against a far
/// background gives the lateral noise, by the scatter of its edge pixels. Bias against distance needs `distances`: a
/// wall alone does not determine its distance. What the recording does not determine keeps its default, as reported in
/// `coefficients`.
/// Deterministic. Throws base::Error (BAD_INPUT) for distances of which none belongs to a frame.
NoiseCalibration calibrateNoise(source::FrameSource& source, const std::vector<MeasuredDistance>& distances,
                                const NoiseCalibrationOptions& options, base::JobControl& control);

/// Lines "stamp_s distance_m", '#' comments. Throws base::Error (NOT_FOUND; BAD_INPUT with file and line).
std::vector<MeasuredDistance> readMeasuredDistances(const std::string& path);

}  // namespace object_modelling::calibration
