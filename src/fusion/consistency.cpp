#include "consistency.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::fusion
{
namespace
{
bool seesThrough(const PreparedView& view, const Eigen::Vector3f& point, float tolerance_m)
{
  return rgbd::visibilityOf(project(view, point), view.nearest_depth_m, tolerance_m) == rgbd::Visibility::IN_FRONT;
}

}  // namespace

Votes castVotes(const std::vector<PreparedView>& views, const SurfacePoint& surface, double consistency_sigmas,
                int own_view)
{
  // Views that vote on an observation; of more, so many evenly chosen ones.
  constexpr int MAX_VOTERS = 64;
  const int count = static_cast<int>(views.size()), voters = std::min(count, MAX_VOTERS);
  Votes votes;
  for (int voter = 0; voter < voters; ++voter)
  {
    const int i = voter * count / voters;
    if (i == own_view)
      continue;
    const PreparedView& view = views[i];
    const geometry::Projection<float> at = project(view, surface.point);
    if (!at.inside)
      continue;
    const double sigma_m = std::hypot(surface.axial_sigma_m, view.frame->noise_model.axialSigma_m(at.z_m, 0));
    const auto tolerance_m = static_cast<float>(consistency_sigmas * sigma_m);
    if (rgbd::visibilityOf(at, view.nearest_depth_m, tolerance_m) == rgbd::Visibility::IN_FRONT)
    {
      if (seesThrough(view, surface.farthest, tolerance_m) &&
          seesThrough(view, 0.5f * (surface.point + surface.farthest), tolerance_m))
        ++votes.seen_through;
      continue;
    }
    const bool facing = surface.normal.dot(view.p_world_camera - surface.point) > 0;
    if (!facing || rgbd::visibilityOf(at, view.frame->depth_m, tolerance_m) != rgbd::Visibility::ON)
      continue;
    ++votes.same;
    if (!view.frame->object_mask.empty())
      ++(view.frame->object_mask.at<unsigned char>(at.row, at.column) ? votes.object : votes.background);
  }
  return votes;
}

std::size_t removeSeenThrough(const std::vector<PreparedView>& views, double consistency_sigmas,
                              std::vector<std::vector<Observation>>* observations_per_view)
{
  std::vector<std::size_t> removed(views.size(), 0);
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < static_cast<int>(observations_per_view->size()); ++i)
  {
    std::vector<Observation>& observations = (*observations_per_view)[i];
    const auto outvoted = [&](const Observation& observation)
    {
      const Eigen::Vector3f ray = (observation.point - views[i].p_world_camera).normalized();
      const auto reach_m = static_cast<float>(consistency_sigmas) * observation.axial_sigma_m;
      const SurfacePoint surface{ observation.point, observation.normal, observation.point + reach_m * ray,
                                  observation.axial_sigma_m };
      const Votes votes = castVotes(views, surface, consistency_sigmas, i);
      return votes.outvoted();
    };
    const auto end = std::remove_if(observations.begin(), observations.end(), outvoted);
    removed[i] = static_cast<std::size_t>(observations.end() - end);
    observations.erase(end, observations.end());
  }
  std::size_t sum = 0;
  for (const std::size_t count : removed)
    sum += count;
  return sum;
}

}  // namespace object_modelling::fusion
