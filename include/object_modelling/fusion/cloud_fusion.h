#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/observation_weight.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::fusion
{
/// Fused surface points; all vectors have the same length. Metres.
struct FusedCloud
{
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;                   ///< outward, unit length
  std::vector<Eigen::Matrix<std::uint8_t, 3, 1>> colors;  ///< RGB
  std::vector<float> weights;                             ///< sum of the observation weights
  std::vector<float> sigmas_m;                            ///< of the position along the normal

  std::size_t size() const { return points.size(); }
};

struct CloudFusionOptions
{
  double resolution_m = 0.002;        ///< spacing of the fused points
  double averaging_radius_m = 0.006;  ///< a fused point averages over this neighbourhood, or a wider one far away
  double min_weight = 0.3;            ///< single observations below are not used
  double consistency_sigmas = 3.0;    ///< contradiction by more than so many sigmas of the better observation
  int min_views = 2;                  ///< fused points seen by fewer are dropped
  rgbd::ObservationWeightOptions weight;
  std::vector<std::string> violations() const;
};

struct CloudFusionResult
{
  base::Status status;  ///< NO_RESULT: nothing left (no masks, no depth); the message says at which step
  FusedCloud cloud;     ///< in the world of the views
  std::size_t observations_used = 0, observations_inconsistent = 0;  ///< pixels in the masks, of at least min_weight
};

/// Noise-weighted fusion of the masked depth of views (Aldoma et al. 2015, section 3.4, corrected: a true weighted
/// mean; points that another view sees through, or that contradict better observations, go). Their poses are taken as
/// given. Deterministic.
CloudFusionResult fuse(const std::vector<rgbd::View>& views, const CloudFusionOptions& options,
                       base::JobControl& control);

}  // namespace object_modelling::fusion
