#include "candidates.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/utility.hpp>

#include "pose_refinement.h"

namespace object_modelling::recognition
{
namespace
{
constexpr double TEXTURE_GATE_M = 0.012, SHAPE_GATE_M = 0.03;  // of the first step of the alignment
constexpr int ITERATIONS = 12;
constexpr double SAME_PLACE_RATIO = 0.05, SAME_ANGLE_RAD = 0.15;  // of poses that are one
constexpr int ENOUGH_FEATURES = 8;                                // of a hypothesis that need not be turned
constexpr int MOST_TURNED = 40;                                   // hypotheses
constexpr float MIN_EXPLAINED = 0.75F, MIN_NORMALS = 0.6F;        // of a hypothesis that is worth turning

std::vector<PoseHypothesis> turns(const Scene& scene, const ObjectKnowledge& object, const Candidate& candidate)
{
  constexpr int STEPS = 18;
  constexpr float SHAPE_LOSS = 0.12F;
  constexpr std::size_t MOST = 4;
  const Eigen::Isometry3d& T_model_box = object.box_model.T_frame_box;
  const float shape = quickScore(scene, object, candidate.hypothesis.T_camera_model.cast<float>(), 4);
  std::vector<std::pair<float, Eigen::Isometry3d>> turns;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 1; i < STEPS; ++i)
    {
      const Eigen::Isometry3d T = candidate.hypothesis.T_camera_model * T_model_box *
                                  Eigen::AngleAxisd(2 * M_PI * i / STEPS, Eigen::Vector3d::Unit(axis)) *
                                  T_model_box.inverse();
      if (quickScore(scene, object, T.cast<float>(), 4) > shape - SHAPE_LOSS)
        turns.emplace_back(-colorCorrelation(scene, object, T.cast<float>()), T);
    }
  std::stable_sort(turns.begin(), turns.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<PoseHypothesis> hypotheses;
  for (std::size_t i = 0; i < std::min(MOST, turns.size()); ++i)
  {
    PoseHypothesis hypothesis = candidate.hypothesis;
    hypothesis.T_camera_model = turns[i].second;
    hypothesis.matched_features = 0;
    hypotheses.push_back(hypothesis);
  }
  return hypotheses;
}
}  // namespace

std::vector<Candidate> judged(const Scene& scene, const KnownObjects& objects,
                              const std::vector<PoseHypothesis>& hypotheses)
{
  std::vector<Candidate> candidates(hypotheses.size());
  cv::parallel_for_(
      cv::Range(0, static_cast<int>(hypotheses.size())),
      [&](const cv::Range& range)
      {
        for (int i = range.start; i < range.end; ++i)
        {
          Candidate& candidate = candidates[static_cast<std::size_t>(i)];
          candidate.hypothesis = hypotheses[static_cast<std::size_t>(i)];
          const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
          const double gate_m = candidate.hypothesis.matched_features > 0 ? TEXTURE_GATE_M : SHAPE_GATE_M;
          candidate.hypothesis.T_camera_model =
              refine(scene, object, candidate.hypothesis.T_camera_model, gate_m, ITERATIONS).T_camera_model;
          const RefinedPose refined = refineWithTexture(scene, object, candidate.hypothesis.T_camera_model, ITERATIONS);
          candidate.hypothesis.T_camera_model = refined.T_camera_model;
          candidate.covariance = refined.covariance;
          candidate.verification = verify(scene, object, candidate.hypothesis.T_camera_model);
          candidate.confidence = confidenceOf(candidate.verification, candidate.hypothesis);
        }
      });
  return candidates;
}

std::vector<Candidate> turned(const Scene& scene, const KnownObjects& objects, const std::vector<Candidate>& candidates)
{
  std::vector<PoseHypothesis> hypotheses;
  int count = 0;
  for (const Candidate& candidate : candidates)
  {
    const Verification& v = candidate.verification;
    if (candidate.hypothesis.matched_features >= ENOUGH_FEATURES || !(v.explained > MIN_EXPLAINED * v.visible()) ||
        !(v.normals_agree > MIN_NORMALS))
      continue;
    if (++count > MOST_TURNED)
      break;
    const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
    for (const PoseHypothesis& hypothesis : turns(scene, object, candidate))
      hypotheses.push_back(hypothesis);
  }
  return judged(scene, objects, hypotheses);
}

std::vector<Candidate> distinct(const KnownObjects& objects, std::vector<Candidate> candidates)
{
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.confidence > b.confidence; });
  const double min_trace = 1 + 2 * std::cos(SAME_ANGLE_RAD);
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates)
  {
    const Eigen::Isometry3d& T = candidate.hypothesis.T_camera_model;
    const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
    const Eigen::Vector3d center = object.center_model.cast<double>();
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const Candidate& other)
                                   {
                                     const Eigen::Isometry3d& U = other.hypothesis.T_camera_model;
                                     return other.hypothesis.object == candidate.hypothesis.object &&
                                            (T * center - U * center).norm() < SAME_PLACE_RATIO * object.diameter_m &&
                                            (T.linear().transpose() * U.linear()).trace() > min_trace;
                                   });
    if (!known)
      kept.push_back(std::move(candidate));
  }
  return kept;
}

}  // namespace object_modelling::recognition
