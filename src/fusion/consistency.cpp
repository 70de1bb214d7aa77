#include "consistency.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::fusion
{
Votes castVotes(const std::vector<View>& views, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                float axial_sigma_m, double consistency_sigmas, int own_view)
{
  Votes votes;
  for (int i = 0; i < static_cast<int>(views.size()); ++i)
  {
    if (i == own_view)
      continue;
    const View& view = views[i];
    const Projection at = project(view, point);
    if (!at.inside)
      continue;
    const float nearest_m = view.nearest_depth_m.at<float>(at.row, at.column);
    if (!std::isfinite(nearest_m))
      continue;
    const double sigma_m = std::hypot(axial_sigma_m, rgbd::axialSigma_m(at.z_m, 0));
    const auto tolerance_m = static_cast<float>(consistency_sigmas * sigma_m);
    if (nearest_m > at.z_m + tolerance_m)
    {
      ++votes.seen_through;
      continue;
    }
    const float depth_m = view.frame->depth_m.at<float>(at.row, at.column);
    const bool facing = normal.dot(view.p_session_camera - point) > 0;
    if (!facing || !(std::abs(depth_m - at.z_m) <= tolerance_m))
      continue;
    ++votes.same;
    if (!view.frame->object_mask.empty())
      ++(view.frame->object_mask.at<unsigned char>(at.row, at.column) ? votes.object : votes.background);
  }
  return votes;
}

std::size_t removeSeenThrough(const std::vector<View>& views, double consistency_sigmas,
                              std::vector<std::vector<Observation>>* observations_per_view)
{
  std::vector<std::size_t> removed(views.size(), 0);
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(observations_per_view->size()); ++i)
  {
    std::vector<Observation>& observations = (*observations_per_view)[i];
    const auto seen_through = [&](const Observation& observation)
    {
      const Votes votes = castVotes(views, observation.point, observation.normal, observation.axial_sigma_m,
                                    consistency_sigmas, observation.view);
      return votes.outvoted();
    };
    const auto end = std::remove_if(observations.begin(), observations.end(), seen_through);
    removed[i] = static_cast<std::size_t>(observations.end() - end);
    observations.erase(end, observations.end());
  }
  std::size_t sum = 0;
  for (const std::size_t count : removed)
    sum += count;
  return sum;
}

}  // namespace object_modelling::fusion
