#include "sight_filter.h"

#include <algorithm>

#include "object_modelling/base/statistics.h"

namespace object_modelling::bundle_adjustment
{
namespace
{
/// Calls select(begin, end) for the range of sights of each landmark; it returns the indices to keep.
template <typename Select>
LandmarkMap keepOf(const LandmarkMap& map, const Select& select)
{
  LandmarkMap kept;
  std::size_t begin = 0;
  for (std::size_t end = 1; end <= map.sights.size(); ++end)
  {
    if (end < map.sights.size() && map.sights[end].landmark == map.sights[begin].landmark)
      continue;
    const std::vector<std::size_t> selected = select(begin, end);
    for (std::size_t i : selected)
    {
      kept.sights.push_back(map.sights[i]);
      kept.sights.back().landmark = static_cast<int>(kept.landmarks.size());
    }
    if (!selected.empty())
      kept.landmarks.push_back(map.landmarks[map.sights[begin].landmark]);
    begin = end;
  }
  return kept;
}

}  // namespace

std::vector<double> sightErrors_sigmas(const std::vector<rgbd::Keyframe>& keyframes, const BundleState& state)
{
  std::vector<double> errors;
  errors.reserve(state.map.sights.size());
  for (const Sight& sight : state.map.sights)
    errors.push_back(sightError(sight, keyframes[sight.keyframe].frame.camera, state).pixel_px / sight.sigma_px);
  return errors;
}

LandmarkMap withoutStrays(const LandmarkMap& map, const std::vector<double>& errors, double limit)
{
  return keepOf(map,
                [&](std::size_t begin, std::size_t end)
                {
                  std::vector<std::size_t> selected;
                  if (base::quantile(std::vector<double>(errors.begin() + static_cast<std::ptrdiff_t>(begin),
                                                         errors.begin() + static_cast<std::ptrdiff_t>(end)),
                                     0.5) > limit)
                    return selected;
                  for (std::size_t i = begin; i < end; ++i)
                    selected.push_back(i);
                  return selected;
                });
}

LandmarkMap withoutOutliers(const LandmarkMap& map, const std::vector<double>& errors, double limit, int min_sights)
{
  return keepOf(map,
                [&](std::size_t begin, std::size_t end)
                {
                  std::vector<std::size_t> selected;
                  for (std::size_t i = begin; i < end; ++i)
                    if (errors[i] <= limit)
                      selected.push_back(i);
                  if (static_cast<int>(selected.size()) < min_sights)
                    selected.clear();
                  return selected;
                });
}

}  // namespace object_modelling::bundle_adjustment
