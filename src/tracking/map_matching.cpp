#include "map_matching.h"

#include <unordered_set>

#include "object_modelling/registration/patch_refinement.h"
#include "object_modelling/rgbd/depth_sampling.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::tracking
{
namespace
{
constexpr double BORDER_PX = 10;
constexpr double MIN_FACING_COSINE = 0.25;  // flatter patches have no texture left
constexpr double MAX_OCCLUSION_STEP_RATIO =
    0.05;  // measured depth nearer than predicted by more: something is in front
constexpr double FLOW_ERROR_PX = 0.7;

Eigen::Matrix3d calibration(const geometry::PinholeCamera& camera)
{
  Eigen::Matrix3d K;
  K << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  return K;
}

bool onObject(const rgbd::Frame& frame, const geometry::Projection<double>& at)
{
  return frame.object_mask.empty() || frame.object_mask.at<std::uint8_t>(at.row, at.column) != 0;
}

bool occluded(const rgbd::Frame& frame, const geometry::Projection<double>& at)
{
  return rgbd::visibilityOf(at, frame.depth_m, MAX_OCCLUSION_STEP_RATIO * at.z_m) == rgbd::Visibility::BEHIND;
}
}  // namespace

std::vector<LandmarkMatch> inliersOf(const std::vector<LandmarkMatch>& matches, const registration::PoseEstimate& pose)
{
  std::vector<LandmarkMatch> inliers;
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (pose.inliers[i])
      inliers.push_back(matches[i]);
  return inliers;
}

std::vector<registration::Correspondence> correspondencesOf(const std::vector<LandmarkMatch>& matches)
{
  std::vector<registration::Correspondence> correspondences;
  correspondences.reserve(matches.size());
  for (const LandmarkMatch& match : matches)
    correspondences.push_back(match.correspondence);
  return correspondences;
}
MapMatches matchMap(const KeyframeMap& map, const rgbd::Frame& frame, const registration::ImagePyramid& pyramid,
                    const Eigen::Isometry3d& T_session_camera,
                    const std::unordered_map<std::uint64_t, Eigen::Vector2f>& flow_pixels,
                    const MapMatchingOptions& options)
{
  MapMatches result;
  const Eigen::Matrix3d K = calibration(frame.camera);
  std::unordered_set<std::uint64_t> tried;
  bool nearest = true;
  for (const MapKeyframe* reference : map.nearestViews(T_session_camera, options.reference_count))
  {
    const Eigen::Isometry3d T_current_reference = T_session_camera.inverse() * reference->T_session_camera;
    int found = 0;
    for (const Sighting& sighting : reference->sightings)
    {
      if (static_cast<int>(result.matches.size()) >= options.max_matches)
        break;
      const Eigen::Vector3d p = T_current_reference * sighting.p_keyframe;
      if (p.z() < 0.05)
        continue;
      const geometry::Projection<double> predicted = geometry::projectionOf(frame.camera, p, BORDER_PX);
      const double facing = -(T_current_reference.linear() * sighting.n_keyframe).dot(p.normalized());
      if (!predicted.inside || facing < MIN_FACING_COSINE || !onObject(frame, predicted) ||
          occluded(frame, predicted) || !tried.insert(sighting.landmark_id).second)
        continue;
      ++result.predicted_count;
      const auto flow = flow_pixels.find(sighting.landmark_id);
      const bool has_flow = flow != flow_pixels.end();
      const Eigen::Matrix3d H = registration::patchHomography(
          K, T_current_reference.linear(), T_current_reference.translation(), sighting.n_keyframe, sighting.p_keyframe);
      const registration::PatchRefinement refined =
          registration::refinePatch(reference->pyramid, pyramid.levels(), H, sighting.pixel,
                                    has_flow ? flow->second : Eigen::Vector2f(predicted.pixel().cast<float>()),
                                    has_flow ? FLOW_ERROR_PX : options.prediction_error_px);
      if (!refined.accepted)
        continue;
      ++found;
      result.matches.push_back({ sighting.landmark_id,
                                 { reference->T_session_camera * sighting.p_keyframe, refined.pixel.cast<double>(),
                                   rgbd::sampleDepth_m(frame.depth_m, refined.pixel.x(), refined.pixel.y()) },
                                 reference->trusted });
    }
    if (nearest && !reference->sightings.empty())
      result.reference_share = static_cast<double>(found) / static_cast<double>(reference->sightings.size());
    nearest = false;
  }
  return result;
}

}  // namespace object_modelling::tracking
