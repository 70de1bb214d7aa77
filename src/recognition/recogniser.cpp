#include "object_modelling/recognition/recogniser.h"

#include <algorithm>

#include "candidates.h"
#include "object_modelling/base/options.h"
#include "shape_votes.h"
#include "texture_index.h"

namespace object_modelling::recognition
{
namespace
{
constexpr double MAX_SHARED_RATIO = 0.25;  // of the explained pixels, with a better hypothesis

Detection detectionOf(const Candidate& candidate, const ObjectKnowledge& object)
{
  Detection detection;
  detection.object_id = object.id;
  detection.content_hash = object.content_hash;
  detection.T_camera_model = candidate.hypothesis.T_camera_model;
  detection.covariance = candidate.covariance;
  detection.confidence_ratio = candidate.confidence;
  detection.visible_ratio = candidate.verification.visible();
  detection.matched_features = candidate.hypothesis.matched_features;
  return detection;
}

/// The most confident ones of those that share pixels.
std::vector<Detection> chosen(const Scene& scene, const KnownObjects& objects, const RecogniserOptions& options,
                              const std::vector<Candidate>& candidates)
{
  const geometry::PinholeCamera& camera = scene.frame.camera;
  std::vector<std::uint8_t> taken(static_cast<std::size_t>(camera.width / VERIFICATION_STEP_PX + 1) *
                                  static_cast<std::size_t>(camera.height / VERIFICATION_STEP_PX + 1));
  std::vector<Detection> detections;
  for (const Candidate& candidate : candidates)
  {
    const Verification& v = candidate.verification;
    const double distance_m = candidate.hypothesis.T_camera_model.translation().z();
    if (candidate.confidence < options.min_confidence_ratio || v.visible() < options.min_visible_ratio ||
        distance_m > options.max_distance_m)
      continue;
    const auto shared = std::count_if(v.pixels.begin(), v.pixels.end(),
                                      [&](int pixel) { return taken[static_cast<std::size_t>(pixel)] != 0; });
    if (static_cast<double>(shared) > MAX_SHARED_RATIO * static_cast<double>(v.pixels.size()))
      continue;
    for (const int pixel : v.pixels)
      taken[static_cast<std::size_t>(pixel)] = 1;
    detections.push_back(detectionOf(candidate, *objects[static_cast<std::size_t>(candidate.hypothesis.object)]));
  }
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Detection& a, const Detection& b) { return a.confidence_ratio > b.confidence_ratio; });
  return detections;
}
}  // namespace

std::vector<std::string> RecogniserOptions::violations() const
{
  base::OptionsCheck check("recogniser");
  check.inRange("min_confidence_ratio", min_confidence_ratio, 0.0, 1.0);
  check.positive("max_distance_m", max_distance_m);
  check.inRange("min_visible_ratio", min_visible_ratio, 0.0, 1.0);
  check.atLeast("max_features", max_features, 10);
  check.atLeast("reference_points", reference_points, 1);
  check.atLeast("max_scene_points", max_scene_points, 10);
  check.atLeast("objects_per_cluster", objects_per_cluster, 1);
  check.atLeast("hypotheses_per_cluster", hypotheses_per_cluster, 1);
  check.atLeast("time_budget_s", time_budget_s, 0.0);
  return check.violations();
}

struct Recogniser::Data
{
  KnownObjects objects;
  RecogniserOptions options;
  TextureIndex texture;

  Scene sceneOf(const rgbd::Frame& frame) const
  {
    double largest_m = 0;
    for (const auto& object : objects)
      largest_m = std::max(largest_m, object->diameter_m);
    return makeScene(frame, largest_m, options.max_distance_m);
  }
};

Recogniser::Recogniser(std::vector<std::shared_ptr<const ObjectKnowledge>> objects, const RecogniserOptions& options)
    : data_(new Data{ objects, base::checked(options), TextureIndex(objects) })
{
}

Recogniser::~Recogniser() = default;

std::vector<Candidate> Recogniser::search(const Scene& scene, const Deadline& deadline) const
{
  const RecogniserOptions& options = data_->options;
  const KnownObjects& objects = data_->objects;
  std::vector<Candidate> candidates;
  if (options.use_texture)
    candidates = judged(
        scene, objects,
        data_->texture.poses(scene, features::detectFeatures(scene.frame, options.max_features, false), options.seed),
        Deadline(0));
  if (options.use_shape)
    for (Candidate& candidate : judged(scene, objects, posesByShape(scene, objects, options, deadline), deadline))
      candidates.push_back(std::move(candidate));
  candidates = distinct(objects, std::move(candidates));
  for (Candidate& candidate : turned(scene, objects, candidates, deadline))
    candidates.push_back(std::move(candidate));
  candidates = distinct(objects, std::move(candidates));
  setConfidences(objects, &candidates);
  return candidates;
}

std::vector<Candidate> Recogniser::candidates(const rgbd::Frame& frame) const
{
  const Deadline deadline(data_->options.time_budget_s);
  return search(data_->sceneOf(frame), deadline);
}

std::vector<Detection> Recogniser::recognise(const rgbd::Frame& frame) const
{
  const Deadline deadline(data_->options.time_budget_s);
  const Scene scene = data_->sceneOf(frame);
  return chosen(scene, data_->objects, data_->options, search(scene, deadline));
}

}  // namespace object_modelling::recognition
