#include "surface_relocaliser.h"

#include <algorithm>
#include <vector>

#include "object_modelling/registration/dense_quality.h"

namespace object_modelling::tracking
{
namespace
{
constexpr std::size_t SIMILAR_CANDIDATES = 3;
constexpr std::size_t NEAR_CANDIDATES = 2;

struct Candidate
{
  const MapKeyframe* keyframe;
  Eigen::Isometry3d T_session_camera_start;
};
}  // namespace

std::optional<registration::DenseAlignment> relocaliseBySurfaces(
    const registration::DensePyramid& frame, const cv::Mat& thumbnail, const KeyframeMap& map,
    const std::optional<Eigen::Isometry3d>& T_session_camera_hint)
{
  std::vector<Candidate> candidates;
  if (T_session_camera_hint)
    for (const MapKeyframe* near : map.nearestViews(*T_session_camera_hint, NEAR_CANDIDATES))
      if (near->trusted)
        candidates.push_back({ near, *T_session_camera_hint });
  for (const MapKeyframe* similar : map.similarImages(thumbnail, SIMILAR_CANDIDATES))
    candidates.push_back({ similar, similar->T_session_camera });
  registration::DenseAlignmentOptions coarse;
  coarse.finest_level = 1;
  coarse.max_iterations = 15;
  registration::DenseAlignment best;
  const MapKeyframe* best_keyframe = nullptr;
  for (const Candidate& candidate : candidates)
  {
    registration::DenseAlignment aligned =
        registration::alignDense(candidate.keyframe->dense(), candidate.keyframe->T_session_camera, frame,
                                 candidate.T_session_camera_start, geometry::Matrix6d::Zero(), coarse);
    if (best_keyframe && registration::quality(aligned.term) <= registration::quality(best.term))
      continue;
    best = std::move(aligned);
    best_keyframe = candidate.keyframe;
  }
  if (!best_keyframe)
    return std::nullopt;
  registration::DenseAlignmentOptions fine;
  fine.coarsest_level = 0;
  best = registration::alignDense(best_keyframe->dense(), best_keyframe->T_session_camera, frame, best.T_world_camera,
                                  geometry::Matrix6d::Zero(), fine);
  if (!best.converged || !registration::certain(best.term))
    return std::nullopt;
  return best;
}

}  // namespace object_modelling::tracking
