#include "landmark_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/rgbd/surface_fit.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
// Rays that meet at less than about 1 deg do not determine the depth of a point.
constexpr double MIN_RAY_SPREAD = 1e-4;

bool usable(const rgbd::Observation& observation, const rgbd::Frame& frame, bool object_only)
{
  if (!observation.pixel.allFinite() || !frame.camera.contains(observation.pixel.cast<double>()))
    return false;
  if (!object_only)
    return true;
  if (frame.object_mask.empty())
    return false;
  const int u = static_cast<int>(std::lround(observation.pixel.x()));
  const int v = static_cast<int>(std::lround(observation.pixel.y()));
  return frame.object_mask.at<std::uint8_t>(v, u) != 0;
}

/// Mean of the points near their coordinate-wise median: one bad depth among three does not move it.
Eigen::Vector3d robustMean(const std::vector<Eigen::Vector3d>& points, double gate_m)
{
  Eigen::Vector3d median;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis)
  {
    for (std::size_t i = 0; i < points.size(); ++i)
      values[i] = points[i][axis];
    median[axis] = base::median(&values);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Eigen::Vector3d& point : points)
  {
    if ((point - median).norm() > gate_m)
      continue;
    sum += point;
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : median;
}

bool intersectRays(const std::vector<Sight>& sights, const std::vector<rgbd::Keyframe>& keyframes,
                   const std::vector<Eigen::Isometry3d>& T_session_camera, Eigen::Vector3d* point)
{
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Sight& sight : sights)
  {
    const Eigen::Isometry3d& T = T_session_camera[sight.keyframe];
    const Eigen::Vector3d ray =
        T.linear() * keyframes[sight.keyframe].frame.camera.unproject(sight.pixel.x(), sight.pixel.y(), 1).normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    A += across;
    b += across * T.translation();
  }
  if (geometry::eigenSystem(A).values[0] < MIN_RAY_SPREAD * static_cast<double>(sights.size()))
    return false;
  *point = geometry::solveSymmetric(A, b);
  return point->allFinite();
}

bool place(const std::vector<Sight>& sights, const std::vector<rgbd::Keyframe>& keyframes,
           const std::vector<Eigen::Isometry3d>& T_session_camera, Eigen::Vector3d* point)
{
  std::vector<Eigen::Vector3d> points;
  double gate_m = 0;
  for (const Sight& sight : sights)
  {
    if (!(sight.depth_m > 0))
      continue;
    const rgbd::Frame& frame = keyframes[sight.keyframe].frame;
    points.push_back(T_session_camera[sight.keyframe] *
                     frame.camera.unproject(sight.pixel.x(), sight.pixel.y(), sight.depth_m));
    gate_m = std::max(gate_m, 4 * frame.noise_model.axialSigma_m(sight.depth_m, 0));
  }
  if (points.empty())
    return intersectRays(sights, keyframes, T_session_camera, point);
  *point = robustMean(points, gate_m);
  return true;
}

/// Eliminating a landmark takes time with the square of its sights, and what is seen from everywhere is known well
/// enough: of many sights some, evenly, and of every landmark others, so that no keyframe is left out.
void thin(std::size_t landmark, std::vector<Sight>* sights)
{
  constexpr std::size_t MAX_SIGHTS = 30;
  constexpr double GOLDEN_RATIO = 0.6180339887498949;
  if (sights->size() <= MAX_SIGHTS)
    return;
  const double phase = std::fmod(GOLDEN_RATIO * static_cast<double>(landmark), 1.0);
  const double step = static_cast<double>(sights->size()) / MAX_SIGHTS;
  for (std::size_t i = 0; i < MAX_SIGHTS; ++i)
    (*sights)[i] = (*sights)[static_cast<std::size_t>((static_cast<double>(i) + phase) * step)];
  sights->resize(MAX_SIGHTS);
}

}  // namespace

std::vector<SightGroup> trackedSights(const std::vector<rgbd::Keyframe>& keyframes, double sigma_px, bool object_only)
{
  std::map<std::uint64_t, SightGroup> groups;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
  {
    for (const rgbd::Observation& observation : keyframes[k].observations)
    {
      if (!usable(observation, keyframes[k].frame, object_only))
        continue;
      std::vector<Sight>& sights = groups[observation.landmark_id].sights;
      if (!sights.empty() && sights.back().keyframe == static_cast<int>(k))
        continue;
      Sight sight;
      sight.keyframe = static_cast<int>(k);
      sight.pixel = observation.pixel.cast<double>();
      sight.depth_m = observation.depth_m;
      sight.sigma_px = sigma_px;
      sights.push_back(sight);
    }
  }
  std::vector<SightGroup> result;
  result.reserve(groups.size());
  for (auto& [id, group] : groups)
    result.push_back(std::move(group));
  return result;
}

LandmarkMap placeLandmarks(const std::vector<SightGroup>& groups, const std::vector<rgbd::Keyframe>& keyframes,
                           const std::vector<Eigen::Isometry3d>& T_session_camera, int min_sights)
{
  LandmarkMap map;
  std::vector<Sight> visible;
  for (const SightGroup& group : groups)
  {
    Eigen::Vector3d point;
    if (static_cast<int>(group.sights.size()) < min_sights || !place(group.sights, keyframes, T_session_camera, &point))
      continue;
    visible.clear();
    for (const Sight& sight : group.sights)
    {
      const Eigen::Isometry3d& T = T_session_camera[sight.keyframe];
      if (T.linear().col(2).dot(point - T.translation()) > 0.02)
        visible.push_back(sight);
    }
    if (static_cast<int>(visible.size()) < min_sights)
      continue;
    thin(map.landmarks.size(), &visible);
    for (Sight& sight : visible)
    {
      sight.landmark = static_cast<int>(map.landmarks.size());
      map.sights.push_back(sight);
    }
    map.landmarks.push_back(point);
  }
  return map;
}

void replaceLandmarks(const std::vector<rgbd::Keyframe>& keyframes,
                      const std::vector<Eigen::Isometry3d>& T_session_camera, LandmarkMap* map)
{
  std::vector<Sight> of_landmark;
  for (std::size_t i = 0; i < map->sights.size(); ++i)
  {
    of_landmark.push_back(map->sights[i]);
    const int landmark = map->sights[i].landmark;
    if (i + 1 < map->sights.size() && map->sights[i + 1].landmark == landmark)
      continue;
    place(of_landmark, keyframes, T_session_camera, &map->landmarks[landmark]);
    of_landmark.clear();
  }
}

void fitDepths(const std::vector<rgbd::Keyframe>& keyframes, LandmarkMap* map)
{
  for (Sight& sight : map->sights)
  {
    if (!(sight.depth_m > 0))
      continue;
    const rgbd::Frame& frame = keyframes[sight.keyframe].frame;
    if (frame.depth_m.empty())
      continue;
    const std::optional<rgbd::SurfacePoint> surface = rgbd::fitSurface(frame, sight.pixel);
    if (!surface)
      continue;
    // A plane has n . p = c, so that z = c / (n . ray).
    const Eigen::Vector2d n_px(surface->n.x() / frame.camera.fx, surface->n.y() / frame.camera.fy);
    const double z = surface->p.z();
    sight.depth_m = z;
    sight.depth_slope_m_px = -z * z / surface->n.dot(surface->p) * n_px;
  }
}

Eigen::MatrixXi sharedLandmarks(const std::vector<SightGroup>& groups, std::size_t keyframe_count)
{
  Eigen::MatrixXi shared =
      Eigen::MatrixXi::Zero(static_cast<Eigen::Index>(keyframe_count), static_cast<Eigen::Index>(keyframe_count));
  for (const SightGroup& group : groups)
    for (const Sight& a : group.sights)
      for (const Sight& b : group.sights)
        if (a.keyframe != b.keyframe)
          ++shared(a.keyframe, b.keyframe);
  return shared;
}

}  // namespace object_modelling::bundle_adjustment
