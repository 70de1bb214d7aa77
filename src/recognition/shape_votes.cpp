#include "shape_votes.h"

#include <algorithm>
#include <numeric>

#include <opencv2/core/utility.hpp>

#include "pose_refinement.h"

namespace object_modelling::recognition
{
namespace
{
constexpr int SCENE_STEP_PX = 2, QUICK_STEP = 8;
constexpr double QUICK_GATE_M = 0.03;
constexpr int QUICK_ITERATIONS = 5;
constexpr std::size_t MOST_ALIGNED_RATIO = 2;
constexpr std::size_t MIN_POINTS = 15;   // of a cluster, that can vote
constexpr std::size_t MOST_SCORED = 60;  // poses of a cluster and object
constexpr double SEEN_RATIO = 0.5;       // of an object's points, that one view shows
constexpr std::size_t LITTLE_POSES = 3;
constexpr double LITTLE_REFERENCES_RATIO = 0.25, LITTLE_POINTS_RATIO = 0.3;  // of the effort, to choose objects by
constexpr double MOST_THINGS = 5;                                            // of a cluster
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

struct Effort
{
  double references = 0, points = 0;  // of a cluster that shows one thing
};

/// A pose of an object in a cluster, and how much of the object's surface is where the scene has one.
struct ScoredPose
{
  float score = 0;
  PoseHypothesis hypothesis;
};

void keepBest(std::size_t most, std::vector<ScoredPose>* poses)
{
  std::stable_sort(poses->begin(), poses->end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  if (poses->size() > most)
    poses->resize(most);
}

/// The best poses by votes, roughly aligned, best score first; at most `most`.
std::vector<ScoredPose> posesIn(const Scene& scene, int segment, const ObjectKnowledge& known, int object,
                                const Effort& effort, std::size_t most)
{
  OrientedPoints points = thinned(pointsOf(scene, segment, SCENE_STEP_PX), known.pairs.spacing_m());
  if (points.size() < MIN_POINTS)
    return {};
  // A cluster of many things has as many points of each as one of a single thing.
  const double things =
      std::clamp(static_cast<double>(points.size()) / (SEEN_RATIO * static_cast<double>(known.pairs.points().size())),
                 1.0, MOST_THINGS);
  points = fewerPoints(std::move(points), static_cast<int>(things * effort.points));
  std::vector<VotedPose> poses;
  std::vector<float> accumulator;
  const std::size_t step =
      std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(things * effort.references));
  for (std::size_t i = step / 2; i < points.size(); i += step)
    known.pairs.vote(points, i, &accumulator, &poses);
  const auto distance_m = static_cast<float>(CLUSTER_DISTANCE_RATIO * known.diameter_m);
  poses = clustered(std::move(poses), known.center_model, distance_m, CLUSTER_ANGLE_RAD);
  if (poses.size() > MOST_SCORED)
    poses.resize(MOST_SCORED);
  std::vector<ScoredPose> result;
  for (const VotedPose& pose : poses)
  {
    PoseHypothesis hypothesis;
    hypothesis.object = object;
    hypothesis.T_camera_model = pose.T_scene_model.cast<double>();
    hypothesis.votes = pose.votes;
    result.push_back({ quickScore(scene, known, pose.T_scene_model, QUICK_STEP), hypothesis });
  }
  keepBest(MOST_ALIGNED_RATIO * most, &result);
  for (ScoredPose& scored : result)
  {
    Eigen::Isometry3d& T = scored.hypothesis.T_camera_model;
    T = refine(scene, known, T, QUICK_GATE_M, QUICK_ITERATIONS, QUICK_STEP / 2).T_camera_model;
    scored.score = quickScore(scene, known, T.cast<float>(), QUICK_STEP / 2);
  }
  keepBest(most, &result);
  return result;
}

/// A cluster and an object that may be in it.
struct Pairing
{
  int segment = 0, object = 0;
  std::vector<ScoredPose> poses;

  float score() const { return poses.empty() ? -1 : poses.front().score; }
};

void findPoses(const Scene& scene, const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects,
               const Effort& effort, std::size_t most, const Deadline& deadline, std::vector<Pairing>* pairings)
{
  cv::parallel_for_(cv::Range(0, static_cast<int>(pairings->size())),
                    [&](const cv::Range& range)
                    {
                      for (int i = range.start; i < range.end && !deadline.passed(); ++i)
                      {
                        Pairing& pairing = pairings->at(static_cast<std::size_t>(i));
                        pairing.poses =
                            posesIn(scene, pairing.segment, *objects[static_cast<std::size_t>(pairing.object)],
                                    pairing.object, effort, most);
                      }
                    });
}

/// Those of each cluster that fit best, half of them by the share of their surface, half by that times their diameter:
/// small things fit into much.
std::vector<Pairing> likely(const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects,
                            std::vector<Pairing> pairings, std::size_t per_cluster)
{
  const auto sized = [&](const Pairing& p)
  { return p.score() * objects[static_cast<std::size_t>(p.object)]->diameter_m; };
  std::vector<bool> kept(pairings.size());
  const auto keep = [&](std::size_t most, const auto& value)
  {
    std::vector<std::size_t> order(pairings.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b)
                     {
                       const Pairing &p = pairings[a], &q = pairings[b];
                       return p.segment != q.segment ? p.segment < q.segment : value(p) > value(q);
                     });
    std::size_t count = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      if (i > 0 && pairings[order[i]].segment != pairings[order[i - 1]].segment)
        count = 0;
      if (count < most && !kept[order[i]])
      {
        kept[order[i]] = true;
        ++count;
      }
    }
  };
  keep((per_cluster + 1) / 2, sized);
  keep(per_cluster / 2, [](const Pairing& p) { return p.score(); });
  std::vector<Pairing> result;
  for (std::size_t i = 0; i < pairings.size(); ++i)
    if (kept[i])
      result.push_back(std::move(pairings[i]));
  return result;
}
}  // namespace

std::vector<PoseHypothesis> posesByShape(const Scene& scene,
                                         const std::vector<std::shared_ptr<const ObjectKnowledge>>& objects,
                                         const RecogniserOptions& options, const Deadline& deadline)
{
  std::vector<Pairing> pairings;
  for (int segment = 0; segment < scene.segment_count; ++segment)
    for (int object = 0; object < static_cast<int>(objects.size()); ++object)
      pairings.push_back({ segment, object, {} });
  const auto candidates = static_cast<std::size_t>(options.objects_per_cluster);
  if (objects.size() > candidates)
  {
    const Effort little{ std::max(1.0, LITTLE_REFERENCES_RATIO * options.reference_points),
                         std::max(10.0, LITTLE_POINTS_RATIO * options.max_scene_points) };
    findPoses(scene, objects, little, LITTLE_POSES, deadline, &pairings);
    pairings = likely(objects, std::move(pairings), candidates);
  }
  findPoses(scene, objects,
            { static_cast<double>(options.reference_points), static_cast<double>(options.max_scene_points) },
            static_cast<std::size_t>(options.hypotheses_per_cluster), deadline, &pairings);
  std::vector<PoseHypothesis> hypotheses;
  for (const Pairing& pairing : pairings)
    for (const ScoredPose& pose : pairing.poses)
      hypotheses.push_back(pose.hypothesis);
  return hypotheses;
}

}  // namespace object_modelling::recognition
