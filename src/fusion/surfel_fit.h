#pragma once

#include <vector>

#include <Eigen/Core>

#include "object_modelling/fusion/cloud_fusion.h"
#include "observation_grid.h"

namespace object_modelling::fusion
{
/// A small piece of surface, averaged from many observations.
struct Surfel
{
  Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  float radius_m = 0;  ///< that it averages over
  float weight = 0;    ///< sum of the noise weights that went in
  float sigma_m = 0;   ///< of the position along the normal
  int views = 0;       ///< distinct views that went in
};

/// The mean of each cell's observations, one for each direction that they face, so that the two sides of a thin wall
/// stay two. Its weight and sigma_m give the information of all of them; its view is 0.
std::vector<Observation> cellMeans(const ObservationGrid& grid);

/// Moves a seed along its normal onto the weighted mean of the observations round it that face the same way and agree
/// with each other; false if too few do. `views_scratch` is as long as there are views.
bool fitSurfel(const ObservationGrid& grid, const CloudFusionOptions& options, int iterations,
               std::vector<char>* views_scratch, Surfel* surfel);

/// All seeds fitted, in parallel; those that fail or have fewer than `min_views` are left out.
std::vector<Surfel> fitSurfels(const ObservationGrid& grid, const CloudFusionOptions& options, int iterations,
                               int view_count, int min_views, std::vector<Surfel> seeds);

/// The surface that the observations give: fitted coarsely to the cells' means first, which leaves few places to fit to
/// the observations themselves.
std::vector<Surfel> fuseSurface(const ObservationGrid& grid, const CloudFusionOptions& options, int view_count);

/// Keeps the best supported of surfels that are nearer to each other than `spacing_m` and face the same way.
std::vector<Surfel> thinOut(const std::vector<Surfel>& surfels, float spacing_m);

}  // namespace object_modelling::fusion
