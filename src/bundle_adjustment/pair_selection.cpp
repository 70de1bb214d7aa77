#include "object_modelling/bundle_adjustment/pair_selection.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace object_modelling::bundle_adjustment
{
namespace
{
constexpr int SAMPLE_STEP_PX = 24;
// Drift allowance of the prediction: pixels beyond the rim of b, and depth in front of or behind b's surface.
constexpr double RIM_RATIO = 0.15;
constexpr double DEPTH_RATIO = 0.2;
// Preemptive matching (Wu, Towards Linear-time Incremental Structure from Motion, 3DV 2013): the few features of
// largest scale decide whether two images show the same thing.
constexpr int PREEMPTIVE_FEATURES = 150;
constexpr int PREEMPTIVE_MATCHES = 6;

struct Candidate
{
  double score = 0;
  int partner = -1;
};

/// The best partners of one keyframe; of equal ones that with the lower index.
void takeBest(int a, std::vector<Candidate> candidates, int count, std::set<IndexPair>* pairs)
{
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.score > y.score; });
  for (int i = 0; i < std::min<int>(count, static_cast<int>(candidates.size())); ++i)
    pairs->insert(std::minmax(a, candidates[i].partner));
}

bool sampled(const rgbd::Frame& frame, int u, int v, bool object_only)
{
  return frame.depthAt_m(u, v) > 0 && (!object_only || frame.object_mask.at<std::uint8_t>(v, u) != 0);
}

}  // namespace

double predictedOverlap(const rgbd::Keyframe& a, const rgbd::Keyframe& b, const KeyframeLinkerOptions& options)
{
  return predictedOverlap(a.frame, b.frame, b.T_session_camera.inverse() * a.T_session_camera, options);
}

double predictedOverlap(const rgbd::Frame& a, const rgbd::Frame& b, const Eigen::Isometry3d& T_b_a,
                        const KeyframeLinkerOptions& options)
{
  const geometry::PinholeCamera& camera_b = b.camera;
  if (a.depth_m.empty() || b.depth_m.empty() ||
      (options.object_only && (a.object_mask.empty() || b.object_mask.empty())))
    return 0;
  const Eigen::Vector3d center_a_in_b = T_b_a.translation();
  const double min_cosine = std::cos(options.max_view_angle_rad);
  const int step = options.object_only ? SAMPLE_STEP_PX / 3 : SAMPLE_STEP_PX;
  int count = 0;
  double seen = 0;
  for (int v = step / 2; v < a.depth_m.rows; v += step)
  {
    for (int u = step / 2; u < a.depth_m.cols; u += step)
    {
      if (!sampled(a, u, v, options.object_only))
        continue;
      ++count;
      const Eigen::Vector3d p_b = T_b_a * a.point(u, v).cast<double>();
      if (!(p_b.z() > 0.05))
        continue;
      const Eigen::Vector2d pixel = camera_b.project(p_b);
      const double cosine = p_b.normalized().dot((p_b - center_a_in_b).normalized());
      if (!camera_b.contains(pixel, -RIM_RATIO * camera_b.width) || cosine < min_cosine)
        continue;
      if (camera_b.contains(pixel))
      {
        // Rounded down: half a pixel is nothing to DEPTH_RATIO.
        const float z = b.depthAt_m(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
        if (std::abs(z - p_b.z()) > DEPTH_RATIO * p_b.z())
          continue;
      }
      seen += cosine;
    }
  }
  return count > 0 ? seen / count : 0;
}

std::vector<IndexPair> selectPairs(const std::vector<rgbd::Keyframe>& keyframes,
                                   const std::vector<features::KeyframeFeatures>& features,
                                   const Eigen::MatrixXi& shared, int enough_shared,
                                   const KeyframeLinkerOptions& options)
{
  const int count = static_cast<int>(keyframes.size());
  const bool by_appearance = count <= options.appearance_limit;
  std::vector<std::vector<Candidate>> overlapping(count), alike(count);
  cv::parallel_for_(cv::Range(0, count),
                    [&](const cv::Range& range)
                    {
                      for (int a = range.start; a < range.end; ++a)
                      {
                        for (int b = 0; b < count; ++b)
                        {
                          if (a == b || shared(a, b) >= enough_shared)
                            continue;
                          const double overlap = predictedOverlap(keyframes[a], keyframes[b], options);
                          if (overlap >= options.min_overlap_ratio)
                            overlapping[a].push_back({ overlap, b });
                          if (!by_appearance || b < a)
                            continue;
                          const std::size_t matches =
                              features::matchFeatures(features[a], features[b], options.max_match_ratio,
                                                      PREEMPTIVE_FEATURES, PREEMPTIVE_FEATURES)
                                  .size();
                          if (matches >= PREEMPTIVE_MATCHES)
                            alike[a].push_back({ static_cast<double>(matches), b });
                        }
                      }
                    });
  std::set<IndexPair> pairs;
  for (int a = 0; a < count; ++a)
  {
    takeBest(a, overlapping[a], options.max_partners, &pairs);
    takeBest(a, alike[a], options.max_partners, &pairs);
  }
  if (count > 2 && shared(0, count - 1) < enough_shared)
    pairs.insert({ 0, count - 1 });
  return { pairs.begin(), pairs.end() };
}

}  // namespace object_modelling::bundle_adjustment
