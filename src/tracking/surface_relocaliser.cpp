#include "surface_relocaliser.h"

#include <algorithm>
#include <vector>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/registration/dense_quality.h"

namespace object_modelling::tracking
{
namespace
{
constexpr std::size_t SIMILAR_CANDIDATES = 3;
constexpr std::size_t NEAR_CANDIDATES = 2;
// Views of one place bring a frame to one pose.
constexpr std::size_t RIVALS = 40;            // keyframes that the pose is checked by
constexpr double RIVAL_QUALITY_RATIO = 0.85;  // of the best: what fits less well speaks of no other place
constexpr double SAME_PLACE_RAD = 0.06;       // coarse alignment, and drift between keyframes
constexpr double SAME_PLACE_DEPTH_RATIO = 0.05;

struct Candidate
{
  const MapKeyframe* keyframe;
  Eigen::Isometry3d T_session_camera_start;
};

registration::DenseAlignment alignCoarsely(const MapKeyframe& keyframe, const registration::DensePyramid& frame,
                                           const Eigen::Isometry3d& T_session_camera_start)
{
  registration::DenseAlignmentOptions coarse;
  coarse.finest_level = 1;
  coarse.max_iterations = 15;
  return registration::alignDense(keyframe.dense(), keyframe.T_session_camera, frame, T_session_camera_start,
                                  geometry::Matrix6d::Zero(), coarse);
}

/// Other poses at which keyframes that look alike hold the frame as surely: a plain round thing on a plain table looks
/// the same from everywhere.
std::vector<Eigen::Isometry3d> rivalsOf(const registration::DenseAlignment& best, double depth_m,
                                        const cv::Mat& thumbnail, const registration::DensePyramid& frame,
                                        const KeyframeMap& map)
{
  std::vector<Eigen::Isometry3d> rivals;
  for (const MapKeyframe* similar : map.similarImages(thumbnail, RIVALS))
  {
    const registration::DenseAlignment other = alignCoarsely(*similar, frame, similar->T_session_camera);
    if (!registration::certain(other.term) ||
        registration::quality(other.term) < RIVAL_QUALITY_RATIO * registration::quality(best.term))
      continue;
    const Eigen::Isometry3d apart = best.T_world_camera.inverse() * other.T_world_camera;
    if (geometry::rotationAngle_rad(apart) > SAME_PLACE_RAD ||
        apart.translation().norm() > SAME_PLACE_DEPTH_RATIO * depth_m)
      rivals.push_back(other.T_world_camera);
  }
  return rivals;
}
}  // namespace

std::optional<RecognisedSurfaces> relocaliseBySurfaces(const registration::DensePyramid& frame,
                                                       const cv::Mat& thumbnail, const KeyframeMap& map,
                                                       const std::optional<Eigen::Isometry3d>& T_session_camera_hint)
{
  std::vector<Candidate> candidates;
  if (T_session_camera_hint)
    for (const MapKeyframe* near : map.nearestViews(*T_session_camera_hint, NEAR_CANDIDATES))
      if (near->trusted)
        candidates.push_back({ near, *T_session_camera_hint });
  for (const MapKeyframe* similar : map.similarImages(thumbnail, SIMILAR_CANDIDATES))
    candidates.push_back({ similar, similar->T_session_camera });
  registration::DenseAlignment best;
  const MapKeyframe* best_keyframe = nullptr;
  for (const Candidate& candidate : candidates)
  {
    registration::DenseAlignment aligned = alignCoarsely(*candidate.keyframe, frame, candidate.T_session_camera_start);
    if (best_keyframe && registration::quality(aligned.term) <= registration::quality(best.term))
      continue;
    best = std::move(aligned);
    best_keyframe = candidate.keyframe;
  }
  if (!best_keyframe)
    return std::nullopt;
  RecognisedSurfaces found;
  registration::DenseAlignmentOptions fine;
  fine.coarsest_level = 0;
  found.aligned = registration::alignDense(best_keyframe->dense(), best_keyframe->T_session_camera, frame,
                                           best.T_world_camera, geometry::Matrix6d::Zero(), fine);
  if (!found.aligned.converged || !registration::certain(found.aligned.term))
    return std::nullopt;
  found.rivals = rivalsOf(best, best_keyframe->median_depth_m, thumbnail, frame, map);
  return found;
}

}  // namespace object_modelling::tracking
