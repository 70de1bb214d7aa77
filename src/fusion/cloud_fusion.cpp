#include "object_modelling/fusion/cloud_fusion.h"

#include <algorithm>

#include "coloring.h"
#include "consistency.h"
#include "object_modelling/base/options.h"
#include "observation.h"
#include "observation_grid.h"
#include "prepared_view.h"
#include "surfel_fit.h"

namespace object_modelling::fusion
{
namespace
{
constexpr int STAGES = 5;

CloudFusionResult nothing(const std::string& step, const std::string& remedy)
{
  CloudFusionResult result;
  result.status = { base::StatusCode::NO_RESULT, "no fused cloud: " + step + "; " + remedy };
  return result;
}

/// What other views see through, what fewer than min_views uphold, and what more views hold for background than for the
/// object (the rim of the table that one mask or another includes), goes.
void removeContradicted(const std::vector<PreparedView>& views, const CloudFusionOptions& options,
                        std::vector<Surfel>* surfels)
{
  std::vector<char> keep(surfels->size(), 0);
#pragma omp parallel for schedule(dynamic, 256)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(surfels->size()); ++i)
  {
    const Surfel& surfel = (*surfels)[i];
    const auto reach_m = static_cast<float>(options.consistency_sigmas) * surfel.sigma_m;
    const SurfacePoint surface{ surfel.point, surfel.normal, surfel.point - reach_m * surfel.normal, surfel.sigma_m };
    const Votes votes = castVotes(views, surface, options.consistency_sigmas);
    keep[i] = !votes.outvoted() && votes.object >= options.min_views && votes.object > votes.background;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surfels->size(); ++i)
  {
    if (keep[i])
      (*surfels)[kept++] = (*surfels)[i];
  }
  surfels->resize(kept);
}

}  // namespace

std::vector<std::string> CloudFusionOptions::violations() const
{
  base::OptionsCheck check("cloud_fusion");
  check.inRange("resolution_m", resolution_m, 1e-4, 0.1);
  check.inRange("averaging_radius_m", averaging_radius_m, 1e-4, 0.1);
  check.inRange("min_weight", min_weight, 0.0, 1.0);
  check.inRange("consistency_sigmas", consistency_sigmas, 1.0, 10.0);
  check.atLeast("min_views", min_views, 1);
  check.include(weight.violations());
  return check.violations();
}

CloudFusionResult fuse(const std::vector<rgbd::View>& views, const CloudFusionOptions& options,
                       base::JobControl& control)
{
  base::checked(options);
  rgbd::checkPlaced(views);
  control.report("fuse", 0, STAGES);
  std::vector<int> with_object;
  for (std::size_t i = 0; i < views.size(); ++i)
  {
    if (hasObject(views[i].frame))
      with_object.push_back(static_cast<int>(i));
  }
  if (with_object.empty())
    return nothing("none of the " + std::to_string(views.size()) + " keyframes has an object mask",
                   "segment the object first");

  const std::vector<PreparedView> prepared = prepareViews(views);
  std::vector<std::vector<Observation>> observations(views.size());
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < static_cast<int>(with_object.size()); ++k)
    observations[with_object[k]] = collectObservations(views[with_object[k]], with_object[k], options);
  std::size_t total = 0;
  for (const auto& of_view : observations)
    total += of_view.size();
  if (total == 0)
    return nothing("no pixel within the masks has depth and a noise weight of at least min_weight",
                   "check the depth images and min_weight");

  control.report("fuse", 1, STAGES);
  CloudFusionResult result;
  result.observations_inconsistent = removeSeenThrough(prepared, options.consistency_sigmas, &observations);
  result.observations_used = total - result.observations_inconsistent;
  if (result.observations_used == 0)
    return nothing("every observation is contradicted by other views", "check the poses of the keyframes");

  control.report("fuse", 2, STAGES);
  const ObservationGrid grid(observations, static_cast<float>(options.resolution_m));
  std::vector<Surfel> surfels = fuseSurface(grid, options, static_cast<int>(views.size()));
  if (surfels.empty())
    return nothing("no surface is seen by min_views = " + std::to_string(options.min_views) + " keyframes",
                   "record more views, or lower min_views");

  control.report("fuse", 3, STAGES);
  removeContradicted(prepared, options, &surfels);
  if (surfels.empty())
    return nothing("every fused point is contradicted by other views or masks", "check poses and masks");

  control.report("fuse", 4, STAGES);
  result.cloud.colors = colorSurfels(prepared, surfels, options.consistency_sigmas);
  for (const Surfel& surfel : surfels)
  {
    result.cloud.points.push_back(surfel.point);
    result.cloud.normals.push_back(surfel.normal);
    result.cloud.weights.push_back(surfel.weight);
    result.cloud.sigmas_m.push_back(surfel.sigma_m);
  }
  control.report("fuse", STAGES, STAGES);
  return result;
}

}  // namespace object_modelling::fusion
