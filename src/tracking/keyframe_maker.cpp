#include "keyframe_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/statistics.h"
#include "object_modelling/rgbd/surface_fit.h"

namespace object_modelling::tracking
{
namespace
{
constexpr int MASK_MARGIN_PX = 4;  // most of a patch must lie on the object

/// Where a landmark may be: with depth, and well inside the object if only that counts.
cv::Mat allowedMask(const rgbd::Frame& frame, bool object_only)
{
  cv::Mat allowed = frame.depth_m == frame.depth_m;  // false for NaN
  if (object_only)
  {
    cv::Mat inner;
    const cv::Mat element =
        cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * MASK_MARGIN_PX + 1, 2 * MASK_MARGIN_PX + 1));
    cv::erode(frame.object_mask, inner, element);
    allowed &= inner;
  }
  return allowed;
}

std::optional<Sighting> makeSighting(std::uint64_t landmark_id, const Eigen::Vector2f& pixel, const rgbd::Frame& frame)
{
  const std::optional<rgbd::SurfacePoint> surface = rgbd::fitSurface(frame, pixel.cast<double>());
  if (!surface)
    return std::nullopt;
  return Sighting{ landmark_id, pixel, surface->p, surface->n };
}

double medianDepth_m(const std::vector<Sighting>& sightings)
{
  if (sightings.empty())
    return 1.0;
  std::vector<double> depths_m;
  for (const Sighting& sighting : sightings)
    depths_m.push_back(sighting.p_keyframe.z());
  return base::median(&depths_m);
}
}  // namespace

NewKeyframe makeKeyframe(int id, const rgbd::Frame& frame, const registration::ImagePyramid& pyramid,
                         const Eigen::Isometry3d& T_session_camera, const std::vector<LandmarkMatch>& matches,
                         bool object_only, const FeatureDetectorOptions& options, std::uint64_t* next_landmark_id)
{
  NewKeyframe made;
  std::vector<Eigen::Vector2f> occupied;
  for (const LandmarkMatch& match : matches)
  {
    const Eigen::Vector2f pixel = match.correspondence.pixel.cast<float>();
    occupied.push_back(pixel);
    made.keyframe.observations.push_back(
        { match.landmark_id, pixel, static_cast<float>(match.correspondence.depth_m) });
    if (const std::optional<Sighting> sighting = makeSighting(match.landmark_id, pixel, frame))
      made.map.sightings.push_back(*sighting);
  }
  for (const Eigen::Vector2f& pixel : detectFeatures(pyramid, allowedMask(frame, object_only), occupied, options))
  {
    const std::optional<Sighting> sighting = makeSighting(*next_landmark_id, pixel, frame);
    if (!sighting)
      continue;
    ++*next_landmark_id;
    made.map.sightings.push_back(*sighting);
    made.keyframe.observations.push_back(
        { sighting->landmark_id, pixel, static_cast<float>(sighting->p_keyframe.z()) });
  }
  made.keyframe.id = made.map.id = id;
  made.keyframe.frame = made.map.frame = frame;
  made.keyframe.T_session_camera = made.map.T_session_camera = T_session_camera;
  made.map.median_depth_m = medianDepth_m(made.map.sightings);
  made.map.pyramid = pyramid.copyLevels();
  return made;
}

}  // namespace object_modelling::tracking
