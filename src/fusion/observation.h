#pragma once

#include <vector>

#include <Eigen/Core>

#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::fusion
{
/// One pixel's measurement of the object's surface, in the world.
struct Observation
{
  Eigen::Vector3f point, normal;
  float weight = 0;         ///< noise weight of the paper, [0, 1]
  float axial_sigma_m = 0;  ///< along the viewing ray
  float sigma_m = 0;        ///< along the normal: axial and lateral noise together
  float lateral_sigma_m = 0;
  int view = 0;  ///< index

  /// What a weighted mean weighs it by.
  float information() const { return weight / (sigma_m * sigma_m); }
};

/// What the masked pixels of a view saw, in the order of the pixels; without those whose noise weight is below
/// min_weight.
std::vector<Observation> collectObservations(const rgbd::View& view, int index, const CloudFusionOptions& options);

}  // namespace object_modelling::fusion
