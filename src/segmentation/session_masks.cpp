#include <algorithm>
#include <cmath>
#include <limits>

#include "object_modelling/base/options.h"
#include "object_modelling/segmentation/object_mask_propagator.h"
#include "support_around.h"

namespace object_modelling::segmentation
{
namespace
{
struct Choice
{
  int keyframe = -1;
  int hypothesis = -1;
  double score = 0;
  double volume_m3 = 0;  ///< of its box
  Eigen::Vector3d centroid_session = Eigen::Vector3d::Zero();
};

/// One keyframe in so many that at most `count` are looked at, evenly over the session.
std::vector<int> sample(const std::vector<rgbd::Keyframe>& keyframes, std::size_t count)
{
  std::vector<int> indices;
  const std::size_t used = std::min(count, keyframes.size());
  for (std::size_t i = 0; i < used; ++i)
    indices.push_back(static_cast<int>(i * keyframes.size() / used));
  return indices;
}

/// The keyframe and hypothesis that show the object most clearly. With a seed point: among the hypotheses round it.
/// Without one: the object is what most views are pointed at, so choices that lie in one place support each other.
base::Result<Choice> chooseStart(const std::vector<rgbd::Keyframe>& keyframes, const SceneSegmenter& segmenter,
                                 const std::optional<Eigen::Vector3d>& seed_point_session)
{
  constexpr std::size_t MAX_VIEWS = 24;
  constexpr double SAME_PLACE_M = 0.06;
  constexpr double MAX_VOLUME_RATIO = 1.6;  // to that of the smaller ones
  std::vector<Choice> choices;
  base::Status reason;
  for (const int i : sample(keyframes, MAX_VIEWS))
  {
    const rgbd::Keyframe& keyframe = keyframes[i];
    const SceneSegmentation segmentation = segmenter.segment(keyframe.frame);
    if (!segmentation.status.ok())
    {
      reason = segmentation.status;
      continue;
    }
    const base::Result<int> chosen =
        seed_point_session ? selectByPoint(segmentation, keyframe.T_session_camera.inverse() * *seed_point_session)
                           : selectAutomatically(segmentation, keyframe.frame.camera);
    if (!chosen.ok())
    {
      reason = chosen.status;
      continue;
    }
    const Hypothesis& hypothesis = segmentation.hypotheses[chosen.value];
    choices.push_back({ i, chosen.value, clearness(hypothesis, keyframe.frame.camera),
                        hypothesis.box_camera.size_m.prod(), keyframe.T_session_camera * hypothesis.centroid_camera });
  }
  if (choices.empty())
    return { { base::StatusCode::NO_RESULT,
               "the object was found in none of the keyframes; the last reason: " + reason.message },
             {} };
  // Where the object has run together with a neighbour the box is larger: such views are no place to start.
  std::vector<double> volumes_m3;
  for (const Choice& choice : choices)
    volumes_m3.push_back(choice.volume_m3);
  std::sort(volumes_m3.begin(), volumes_m3.end());
  const double max_volume_m3 = MAX_VOLUME_RATIO * volumes_m3[volumes_m3.size() / 5];

  Choice best;
  double best_support = -1;
  for (const Choice& choice : choices)
  {
    if (choice.volume_m3 > max_volume_m3)
      continue;
    double support = choice.score;
    for (const Choice& other : choices)
      if ((other.centroid_session - choice.centroid_session).norm() < SAME_PLACE_M)
        support += other.score;
    if (support > best_support)
    {
      best = choice;
      best_support = support;
    }
  }
  return { {}, best };
}

/// From the start to the nearest view, then to the one nearest to any of those already visited: new sides come into
/// view little by little.
std::vector<int> nearestFirst(const std::vector<rgbd::Keyframe>& keyframes, int start)
{
  const auto far = std::numeric_limits<double>::infinity();
  std::vector<double> distance_m(keyframes.size(), far);
  std::vector<bool> visited(keyframes.size(), false);
  std::vector<int> order;
  for (int current = start; current >= 0;)
  {
    visited[current] = true;
    order.push_back(current);
    int next = -1;
    for (std::size_t i = 0; i < keyframes.size(); ++i)
    {
      if (visited[i])
        continue;
      const double d_m =
          (keyframes[i].T_session_camera.translation() - keyframes[current].T_session_camera.translation()).norm();
      distance_m[i] = std::min(distance_m[i], d_m);
      if (next < 0 || distance_m[i] < distance_m[next])
        next = static_cast<int>(i);
    }
    current = next;
  }
  return order;
}

/// The support plane that most views of masked keyframes agree on.
std::optional<geometry::Plane> agreedSupport(const std::vector<rgbd::Keyframe>& keyframes)
{
  constexpr double SAME_NORMAL_COS = 0.9962;  // 5 deg
  constexpr double SAME_OFFSET_M = 0.01;
  struct Candidate
  {
    geometry::Plane plane_session;
    PlaneMoments moments;
    Eigen::Vector3d camera_session;
  };
  std::vector<Candidate> candidates;
  for (const rgbd::Keyframe& keyframe : keyframes)
    if (const auto support = findSupportAround(keyframe.frame, keyframe.frame.object_mask))
      candidates.push_back({ geometry::transformed(keyframe.T_session_camera, support->plane_camera),
                             support->moments.transformed(keyframe.T_session_camera),
                             keyframe.T_session_camera.translation() });
  const auto agree = [&](const Candidate& a, const Candidate& b)
  {
    return a.plane_session.normal.dot(b.plane_session.normal) > SAME_NORMAL_COS &&
           std::abs(a.plane_session.signedDistance_m(b.moments.mean())) < SAME_OFFSET_M;
  };
  std::optional<geometry::Plane> best;
  int best_count = 0;
  for (const Candidate& candidate : candidates)
  {
    PlaneMoments joint;
    int count = 0;
    for (const Candidate& other : candidates)
      if (agree(candidate, other))
      {
        joint.add(other.moments);
        ++count;
      }
    geometry::Plane plane;
    if (count > best_count && joint.fit(candidate.camera_session, &plane))
    {
      best = plane;
      best_count = count;
    }
  }
  return best;
}

bool hasMask(const rgbd::Keyframe& keyframe)
{
  return !keyframe.frame.object_mask.empty();
}

}  // namespace

SessionMasks segmentSession(const std::vector<rgbd::Keyframe>& keyframes,
                            const std::optional<Eigen::Vector3d>& seed_point_session,
                            const ObjectMaskPropagatorOptions& options)
{
  base::checked(options);
  SessionMasks result;
  result.masks.resize(keyframes.size());
  if (keyframes.empty())
  {
    result.status = { base::StatusCode::FAILED_PRECONDITION, "the session has no keyframes" };
    return result;
  }
  for (const rgbd::Keyframe& keyframe : keyframes)
    if (hasMask(keyframe) && (keyframe.frame.object_mask.size() != keyframe.frame.depth_m.size() ||
                              keyframe.frame.object_mask.type() != CV_8UC1))
    {
      result.status = { base::StatusCode::BAD_INPUT, "the object mask of keyframe " + std::to_string(keyframe.id) +
                                                         " is not a CV_8UC1 image of the size of its depth image" };
      return result;
    }
  if (std::all_of(keyframes.begin(), keyframes.end(), hasMask))
  {
    for (std::size_t i = 0; i < keyframes.size(); ++i)
      result.masks[i] = keyframes[i].frame.object_mask;
    result.support_plane_session = agreedSupport(keyframes);
    return result;
  }

  constexpr int RECOUNTS = 2;  // what the first takes out of the volume changes how the second sees its neighbours
  const SceneSegmenter segmenter(options.segmenter);
  const base::Result<Choice> start = chooseStart(keyframes, segmenter, seed_point_session);
  if (!start.ok())
  {
    result.status = start.status;
    return result;
  }
  ObjectMaskPropagator propagator(options);
  const rgbd::Keyframe& first = keyframes[start.value.keyframe];
  result.status = propagator.start(first, segmenter.segment(first.frame), start.value.hypothesis);
  if (!result.status.ok())
    return result;
  for (const int i : nearestFirst(keyframes, start.value.keyframe))
    propagator.propagate(keyframes[i]);
  for (int round = 0; round < RECOUNTS; ++round)
    propagator.recount(keyframes);
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    result.masks[i] = hasMask(keyframes[i]) ? keyframes[i].frame.object_mask : propagator.mask(keyframes[i]).value;
  result.support_plane_session = propagator.supportPlane();
  return result;
}

}  // namespace object_modelling::segmentation
