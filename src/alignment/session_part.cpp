#include "object_modelling/alignment/session_part.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/options.h"
#include "object_modelling/features/keyframe_features.h"
#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/registration/invariant_colors.h"
#include "object_modelling/rgbd/keyframe_view.h"
#include "object_modelling/rgbd/pose_certainty.h"

namespace object_modelling::alignment
{
namespace
{
constexpr int MIN_POINTS = 100;

base::Error nothing(const std::string& session_id, const std::string& what)
{
  return { base::StatusCode::FAILED_PRECONDITION, "session '" + session_id + "' " + what };
}

/// One point per cell of `spacing_m`, the first.
std::vector<int> thinned(const std::vector<Eigen::Vector3f>& points, double spacing_m)
{
  std::vector<int> kept;
  std::unordered_set<std::int64_t> taken;
  for (int i = 0; i < static_cast<int>(points.size()); ++i)
  {
    const Eigen::Vector3i cell = (points[i] / static_cast<float>(spacing_m)).array().floor().cast<int>();
    constexpr std::int64_t SIDE = 1 << 20;
    if (taken.insert(((cell.z() + SIDE / 2) * SIDE + cell.y() + SIDE / 2) * SIDE + cell.x() + SIDE / 2).second)
      kept.push_back(i);
  }
  return kept;
}

registration::SpaceView spaceOf(const rgbd::View& view, const Eigen::Vector3f& center)
{
  registration::SpaceView space;
  space.camera = view.frame.camera;
  space.T_camera_session = view.T_world_camera.inverse().cast<float>();
  cv::Mat known = view.frame.depth_m.clone();
  known.setTo(0, known != known);  // NaN
  cv::erode(known, space.least_depth_m, cv::Mat());
  space.axial_sigma_m = view.frame.noise_model.axialSigma_m((space.T_camera_session * center).z(), 0);
  return space;
}

registration::ObjectFeatures featuresOf(const rgbd::View& view, int max_features)
{
  const features::KeyframeFeatures found = features::detectFeatures(view.frame, max_features, true);
  registration::ObjectFeatures features;
  features.norm = found.norm;
  for (std::size_t i = 0; i < found.features.size(); ++i)
  {
    if (!found.features[i].p_camera.allFinite())
      continue;
    features.points.emplace_back((view.T_world_camera * found.features[i].p_camera).cast<float>());
    features.descriptors.push_back(found.descriptors.row(static_cast<int>(i)));
  }
  return features;
}

/// What shows the object from where it is known.
struct KnownViews
{
  std::vector<rgbd::View> views;
  std::string doubt;  ///< why hardly any is known; then all are there
};

KnownViews knownViewsOf(const keyframes::Session& session, const std::vector<rgbd::Keyframe>& keyframes,
                        const std::vector<int>& masked)
{
  std::vector<rgbd::View> views;
  for (const int index : masked)
    views.push_back(
        rgbd::viewOf(keyframes[index], Eigen::Isometry3d::Identity(), 0, session.calibration.color_offset_px));
  const rgbd::PathCertainty path = rgbd::pathCertainty(views);
  KnownViews known;
  std::vector<int> ids;
  for (const int index : masked)
    ids.push_back(keyframes[index].id);
  if (path.doubtful)
    known.doubt = describe(path, ids, session.id);
  for (const std::size_t i : rgbd::knownViews(path, views.size()))
    known.views.push_back(views[i]);
  return known;
}

/// Views that look from as different directions as there are: each next one is farthest from those chosen.
std::vector<std::size_t> spreadViews(const std::vector<rgbd::View>& views, const Eigen::Vector3f& center, int count)
{
  std::vector<Eigen::Vector3d> directions;
  for (const rgbd::View& view : views)
    directions.push_back((view.T_world_camera.translation() - center.cast<double>()).normalized());
  std::vector<double> nearest(views.size(), -2);  // cosine to the nearest chosen one
  std::vector<std::size_t> chosen;
  std::size_t next = 0;
  while (chosen.size() < std::min(static_cast<std::size_t>(count), views.size()))
  {
    chosen.push_back(next);
    nearest[next] = 2;
    for (std::size_t i = 0; i < views.size(); ++i)
      nearest[i] = std::max(nearest[i], directions[i].dot(directions[next]));
    next = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return chosen;
}

/// Of a few views, what is looked up in them.
void addViews(const std::vector<rgbd::View>& views, const PartialModelOptions& options,
              registration::PartialModel* model)
{
  const Eigen::Vector3f center = model->center();
  const std::vector<std::size_t> chosen = spreadViews(views, center, options.max_views);
  model->views.resize(chosen.size());
  model->features.resize(chosen.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(chosen.size()); ++i)
  {
    model->views[i] = spaceOf(views[chosen[i]], center);
    if (options.use_color && options.max_features > 0)
      model->features[i] = featuresOf(views[chosen[i]], options.max_features);
  }
}
}  // namespace

std::vector<std::string> PartialModelOptions::violations() const
{
  base::OptionsCheck check("partial_model");
  check.inRange("spacing_m", spacing_m, 0.0005, 0.05);
  check.inRange("max_points", max_points, 500, 100000);
  check.inRange("max_views", max_views, 1, 1000);
  check.inRange("max_features", max_features, 0, 10000);
  return check.violations();
}

registration::PartialModel makePartialModel(const keyframes::Session& session,
                                            const std::vector<rgbd::Keyframe>& keyframes,
                                            const PartialModelOptions& options, base::JobControl& control)
{
  base::checked(options);
  control.checkCancelled();
  std::vector<int> masked;
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    if (!keyframes[i].frame.object_mask.empty() && cv::countNonZero(keyframes[i].frame.object_mask) > 0)
      masked.push_back(static_cast<int>(i));
  if (masked.empty())
    throw nothing(session.id, "has no object mask in any of its " + std::to_string(keyframes.size()) +
                                  " keyframes: select the object (segmenter) before aligning");
  fusion::CloudFusionOptions fusion_options;
  fusion_options.resolution_m = options.spacing_m;
  base::JobControl silent;
  const KnownViews known = knownViewsOf(session, keyframes, masked);
  const fusion::CloudFusionResult fused = fusion::fuse(known.views, fusion_options, silent);
  control.checkCancelled();
  if (!fused.status.ok())
    throw nothing(session.id, "cannot be aligned: " + fused.status.message);
  registration::PartialModel model = partOf(session.id, fused.cloud, known.views, options);
  model.doubt = known.doubt;
  model.support_plane = session.support_plane_session;
  return model;
}

registration::PartialModel partOf(const std::string& id, const fusion::FusedCloud& cloud,
                                  const std::vector<rgbd::View>& views, const PartialModelOptions& options)
{
  base::checked(options);
  registration::PartialModel model;
  model.session_id = id;
  model.spacing_m =
      options.spacing_m *
      std::sqrt(std::max(1.0, static_cast<double>(cloud.size()) / static_cast<double>(options.max_points)));
  const std::vector<int> kept = thinned(cloud.points, model.spacing_m);
  if (static_cast<int>(kept.size()) < MIN_POINTS)
    throw base::Error(base::StatusCode::FAILED_PRECONDITION,
                      "'" + id + "' shows only " + std::to_string(kept.size()) + " points of the object, " +
                          std::to_string(model.spacing_m * 1000) + " mm apart (at least " + std::to_string(MIN_POINTS) +
                          " are needed): record it from nearer");
  for (const int index : kept)
  {
    model.points.push_back(cloud.points[index]);
    model.normals.push_back(cloud.normals[index]);
    model.colors_rgb.push_back(cloud.colors[index]);
  }
  if (options.use_color)
    model.colors = registration::invariantColors(model.points, model.normals, model.colors_rgb);
  else
    model.colors.assign(kept.size(), Eigen::Vector3f::Zero());
  addViews(views, options, &model);
  return model;
}

}  // namespace object_modelling::alignment
