#include "candidates.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/utility.hpp>

#include "evidence.h"
#include "pose_refinement.h"

namespace object_modelling::recognition
{
namespace
{
constexpr double TEXTURE_GATE_M = 0.012, SHAPE_GATE_M = 0.03;  // of the first step of the alignment
constexpr int ITERATIONS = 12;
constexpr double SAME_PLACE_RATIO = 0.05, SAME_ANGLE_RAD = 0.15;  // of poses that are one
constexpr double RIVAL_PLACE_RATIO = 0.4, RIVAL_ANGLE_RAD = 0.3;  // of poses that cannot both be right
constexpr int ENOUGH_FEATURES = 8;                                // of a hypothesis that need not be turned
constexpr float MIN_QUICK_SCORE = 0.1F;                           // of a hypothesis that is worth verifying
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
                              const std::vector<PoseHypothesis>& hypotheses, const Deadline& deadline)
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
          candidate.score = LEAST_SCORE;
          if (deadline.passed())
            continue;
          const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
          const double gate_m = candidate.hypothesis.matched_features > 0 ? TEXTURE_GATE_M : SHAPE_GATE_M;
          candidate.hypothesis.T_camera_model =
              refine(scene, object, candidate.hypothesis.T_camera_model, gate_m, ITERATIONS).T_camera_model;
          if (candidate.hypothesis.matched_features == 0 &&
              quickScore(scene, object, candidate.hypothesis.T_camera_model.cast<float>(), 4) < MIN_QUICK_SCORE)
            continue;
          const RefinedPose refined = refineWithTexture(scene, object, candidate.hypothesis.T_camera_model, ITERATIONS);
          candidate.hypothesis.T_camera_model = refined.T_camera_model;
          candidate.covariance = refined.covariance;
          candidate.verification = verify(scene, object, candidate.hypothesis.T_camera_model);
          candidate.score = scoreOf(candidate.verification, candidate.hypothesis);
        }
      });
  return candidates;
}

std::vector<Candidate> turned(const Scene& scene, const KnownObjects& objects, const std::vector<Candidate>& candidates,
                              const Deadline& deadline)
{
  std::vector<PoseHypothesis> hypotheses;
  int count = 0;
  for (const Candidate& candidate : candidates)
  {
    const Verification& v = candidate.verification;
    if (candidate.hypothesis.matched_features >= ENOUGH_FEATURES || !(v.explained > MIN_EXPLAINED * v.visible()) ||
        !(v.normals_agree > MIN_NORMALS))
      continue;
    if (++count > MOST_TURNED || deadline.passed())
      break;
    const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
    for (const PoseHypothesis& hypothesis : turns(scene, object, candidate))
      hypotheses.push_back(hypothesis);
  }
  return judged(scene, objects, hypotheses, deadline);
}

Eigen::Vector3d centerOf(const KnownObjects& objects, const Candidate& candidate)
{
  const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
  return candidate.hypothesis.T_camera_model * object.center_model.cast<double>();
}

double turnBetween(const KnownObjects& objects, const Candidate& a, const Candidate& b)
{
  const ObjectKnowledge& object = *objects[static_cast<std::size_t>(a.hypothesis.object)];
  return object.symmetries.angleBetween(a.hypothesis.T_camera_model.linear(), b.hypothesis.T_camera_model.linear());
}

std::vector<Candidate> distinct(const KnownObjects& objects, std::vector<Candidate> candidates)
{
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates)
  {
    const ObjectKnowledge& object = *objects[static_cast<std::size_t>(candidate.hypothesis.object)];
    const bool known = std::any_of(kept.begin(), kept.end(),
                                   [&](const Candidate& other)
                                   {
                                     return other.hypothesis.object == candidate.hypothesis.object &&
                                            (centerOf(objects, candidate) - centerOf(objects, other)).norm() <
                                                SAME_PLACE_RATIO * object.diameter_m &&
                                            turnBetween(objects, candidate, other) < SAME_ANGLE_RAD;
                                   });
    if (!known)
      kept.push_back(std::move(candidate));
  }
  return kept;
}

void setConfidences(const KnownObjects& objects, std::vector<Candidate>* candidates)
{
  for (Candidate& candidate : *candidates)
  {
    const double diameter_m = objects[static_cast<std::size_t>(candidate.hypothesis.object)]->diameter_m;
    const auto rivals = [&](const Candidate& other)
    {
      const double other_m = objects[static_cast<std::size_t>(other.hypothesis.object)]->diameter_m;
      if ((centerOf(objects, candidate) - centerOf(objects, other)).norm() >
          RIVAL_PLACE_RATIO * std::min(diameter_m, other_m))
        return false;
      return other.hypothesis.object != candidate.hypothesis.object ||
             turnBetween(objects, candidate, other) > RIVAL_ANGLE_RAD;
    };
    const auto rival = std::find_if(candidates->begin(), candidates->end(), rivals);
    candidate.rival_score = rival == candidates->end() ? LEAST_SCORE : rival->score;
    candidate.confidence = candidate.rival_score > candidate.score ? 0 : confidenceOf(candidate);
  }
}

}  // namespace object_modelling::recognition
