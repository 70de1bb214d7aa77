#include "object_modelling/registration/point_matches.h"

#include "object_modelling/features/keyframe_features.h"

namespace object_modelling::registration
{
namespace
{
constexpr double MAX_RATIO = 0.85;

std::vector<PointMatch> matchesOf(const ObjectFeatures& a, const ObjectFeatures& b)
{
  features::KeyframeFeatures of_a, of_b;
  of_a.descriptors = a.descriptors;
  of_b.descriptors = b.descriptors;
  of_a.norm = a.norm;
  of_b.norm = b.norm;
  std::vector<PointMatch> matches;
  for (const features::DescriptorMatch& match : features::matchFeatures(of_a, of_b, MAX_RATIO))
    matches.push_back({ a.points[match.a], b.points[match.b] });
  return matches;
}
}  // namespace

std::vector<PointMatch> matchPoints(const MatchedSurface& a, const MatchedSurface& b, [[maybe_unused]] int threads)
{
  const auto views_b = static_cast<int>(b.model.features.size());
  const auto pairs = static_cast<int>(a.model.features.size()) * views_b;
  std::vector<std::vector<PointMatch>> by_pair(pairs);
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (int i = 0; i < pairs; ++i)
    by_pair[i] = matchesOf(a.model.features[i / views_b], b.model.features[i % views_b]);
  std::vector<PointMatch> matches;
  for (const std::vector<PointMatch>& of_pair : by_pair)
    matches.insert(matches.end(), of_pair.begin(), of_pair.end());
  return matches;
}

std::vector<int> upholding(const std::vector<PointMatch>& matches, const Eigen::Isometry3f& T_a_b, float max_distance_m)
{
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(matches.size()); ++i)
    if ((T_a_b * matches[i].b - matches[i].a).squaredNorm() < max_distance_m * max_distance_m)
      result.push_back(i);
  return result;
}

}  // namespace object_modelling::registration
