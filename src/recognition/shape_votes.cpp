#include "shape_votes.h"

#include <algorithm>

#include <opencv2/core/utility.hpp>

#include "pose_refinement.h"

namespace object_modelling::recognition
{
namespace
{
constexpr int SCENE_STEP_PX = 2, QUICK_STEP = 8;
constexpr std::size_t MIN_POINTS = 15;   // of a cluster, that can vote
constexpr std::size_t MOST_SCORED = 60;  // poses of a cluster and object
constexpr double CLUSTER_DISTANCE_RATIO = 0.1, CLUSTER_ANGLE_RAD = 0.35;

/// Every n-th, so that at most `most` remain.
OrientedPoints fewerPoints(OrientedPoints points, int most)
{
  if (points.size() <= static_cast<std::size_t>(most))
    return points;
  OrientedPoints fewer;
  const std::size_t step = points.size() / static_cast<std::size_t>(most) + 1;
  for (std::size_t i = 0; i < points.size(); i += step)
  {
    fewer.points.push_back(points.points[i]);
    fewer.normals.push_back(points.normals[i]);
  }
  return fewer;
}

std::vector<PoseHypothesis> posesIn(const Scene& scene, int segment, const ObjectKnowledge& known, int object,
                                    const RecogniserOptions& options)
{
  const OrientedPoints points =
      fewerPoints(thinned(pointsOf(scene, segment, SCENE_STEP_PX), known.pairs.spacing_m()), options.max_scene_points);
  if (points.size() < MIN_POINTS)
    return {};
  std::vector<VotedPose> poses;
  std::vector<float> accumulator;
  const std::size_t step = std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(options.reference_points));
  for (std::size_t i = step / 2; i < points.size(); i += step)
    known.pairs.vote(points, i, &accumulator, &poses);
  const auto distance_m = static_cast<float>(CLUSTER_DISTANCE_RATIO * known.diameter_m);
  poses = clustered(std::move(poses), known.center_model, distance_m, CLUSTER_ANGLE_RAD);
  if (poses.size() > MOST_SCORED)
    poses.resize(MOST_SCORED);
  std::vector<std::pair<float, std::size_t>> scores;
  for (std::size_t i = 0; i < poses.size(); ++i)
    scores.emplace_back(-quickScore(scene, known, poses[i].T_scene_model, QUICK_STEP), i);
  std::stable_sort(scores.begin(), scores.end());
  std::vector<PoseHypothesis> result;
  for (const auto& [score, i] : scores)
  {
    if (static_cast<int>(result.size()) >= options.hypotheses_per_cluster)
      break;
    PoseHypothesis hypothesis;
    hypothesis.object = object;
    hypothesis.T_camera_model = poses[i].T_scene_model.cast<double>();
    hypothesis.votes = poses[i].votes;
    result.push_back(hypothesis);
  }
  return result;
}
}  // namespace

std::vector<PoseHypothesis> posesByShape(const Scene& scene,
                                         const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects,
                                         const RecogniserOptions& options)
{
  const int object_count = static_cast<int>(objects.size());
  std::vector<std::vector<PoseHypothesis>> found(static_cast<std::size_t>(scene.segment_count * object_count));
  cv::parallel_for_(cv::Range(0, static_cast<int>(found.size())),
                    [&](const cv::Range& range)
                    {
                      for (int i = range.start; i < range.end; ++i)
                      {
                        const int object = i % object_count;
                        found[static_cast<std::size_t>(i)] = posesIn(
                            scene, i / object_count, *objects[static_cast<std::size_t>(object)], object, options);
                      }
                    });
  std::vector<PoseHypothesis> hypotheses;
  for (const std::vector<PoseHypothesis>& some : found)
    hypotheses.insert(hypotheses.end(), some.begin(), some.end());
  return hypotheses;
}

}  // namespace object_modelling::recognition
