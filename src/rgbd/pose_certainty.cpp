#include "object_modelling/rgbd/pose_certainty.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::rgbd
{
namespace
{
constexpr double MAX_TRANSLATION_RATIO = 0.02;  // of the depth
constexpr double MAX_ROTATION_RAD = 0.02;
constexpr double MOST_SHOWN = 1e6;       // in texts: beyond it digits are meaningless
constexpr double NEGATIVE_RATIO = 1e-6;  // of the greatest variance, by rounding
constexpr std::size_t MIN_KNOWN = 2;     // a surface is what two views see
constexpr std::size_t MOST_NAMED = 12;   // of keyframes in a text
constexpr int DEPTH_STEP_PX = 8;         // of the pixels that a view's depth is read from

/// Infinite where the covariance is none.
double greatestSigma(const Eigen::Matrix3d& block)
{
  if (!block.allFinite())
    return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d variances = geometry::eigenSystem(block).values;
  const bool is_covariance = variances.x() >= -NEGATIVE_RATIO * std::abs(variances.z());
  return is_covariance ? std::sqrt(std::max(0.0, variances.z())) : std::numeric_limits<double>::infinity();
}

/// Median over the object where it is known, else over the image; 0 without depth.
double depthOf_m(const Frame& frame)
{
  std::vector<float> depths_m;
  for (int v = 0; v < frame.depth_m.rows; v += DEPTH_STEP_PX)
    for (int u = 0; u < frame.depth_m.cols; u += DEPTH_STEP_PX)
      if (const float depth_m = frame.depth_m.at<float>(v, u);
          depth_m > 0 && (frame.object_mask.empty() || frame.object_mask.at<std::uint8_t>(v, u) > 0))
        depths_m.push_back(depth_m);
  return base::median(&depths_m);
}
}  // namespace

bool PoseSigma::isKnown(double depth_m) const
{
  return translation_m <= MAX_TRANSLATION_RATIO * depth_m && rotation_rad <= MAX_ROTATION_RAD;
}

std::string PoseSigma::text() const
{
  const auto rounded = [](double value) { return std::to_string(std::lround(std::min(1e3 * value, MOST_SHOWN))); };
  return rounded(translation_m) + " mm, " + rounded(rotation_rad) + " mrad";
}

PoseSigma poseSigma(const geometry::Matrix6d& covariance_camera)
{
  return { greatestSigma(covariance_camera.topLeftCorner<3, 3>()),
           greatestSigma(covariance_camera.bottomRightCorner<3, 3>()) };
}

geometry::Matrix6d inCameraFrame(const geometry::Matrix6d& covariance_world, const Eigen::Isometry3d& T_world_camera)
{
  const geometry::Matrix6d adjoint = geometry::adjoint(T_world_camera.inverse());
  return adjoint * covariance_world * adjoint.transpose();
}

PathCertainty pathCertainty(const std::vector<View>& views)
{
  PathCertainty path;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    if (views[i].covariance.isZero(0))
      continue;
    const double depth_m = depthOf_m(views[i].frame);
    const PoseSigma sigma = poseSigma(inCameraFrame(views[i].covariance, views[i].T_world_camera));
    if (depth_m <= 0 || sigma.isKnown(depth_m))
      continue;
    path.unknown.push_back(i);
    path.worst.translation_m = std::max(path.worst.translation_m, sigma.translation_m);
    path.worst.rotation_rad = std::max(path.worst.rotation_rad, sigma.rotation_rad);
  }
  path.doubtful =
      !path.allKnown() && (2 * path.unknown.size() > views.size() || views.size() - path.unknown.size() < MIN_KNOWN);
  return path;
}

std::string describe(const PathCertainty& path, const std::vector<int>& keyframe_ids, const std::string& session_id)
{
  if (path.allKnown())
    return {};
  std::string ids;
  for (std::size_t i = 0; i < std::min(MOST_NAMED, path.unknown.size()); ++i)
    ids += (i == 0 ? "" : ", ") + std::to_string(keyframe_ids[path.unknown[i]]);
  if (path.unknown.size() > MOST_NAMED)
    ids += ", ...";
  const std::string text = "session '" + session_id + "': where the camera was is not known for " +
                           std::to_string(path.unknown.size()) + " of " + std::to_string(keyframe_ids.size()) +
                           " keyframes (" + ids + "; unsure by up to " + path.worst.text() + ")";
  return text + (path.doubtful ? "" : ", which are left out") +
         ": record again with something textured under or beside the object";
}

std::vector<std::size_t> knownViews(const PathCertainty& path, std::size_t views)
{
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < views; ++i)
    if (path.doubtful || !std::binary_search(path.unknown.begin(), path.unknown.end(), i))
      known.push_back(i);
  return known;
}

}  // namespace object_modelling::rgbd
