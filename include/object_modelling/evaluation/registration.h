#pragma once

#include <optional>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/mesh/reference_surface.h"

namespace object_modelling::evaluation
{
struct RegistrationOptions
{
  int start_count = 400;         ///< orientations tried where there is no initial guess, spread evenly
  double overlap_ratio = 0.8;    ///< share of the points that take part in the search: the rest may have no partner
  int search_point_count = 250;  ///< points of the search, and of the final fit
  int fit_point_count = 8000;
  int max_iterations = 100;  ///< of the final fit
  std::vector<std::string> violations() const;
};

struct RegistrationResult
{
  base::Status status;  ///< NO_RESULT: the points do not fix a pose
  Eigen::Isometry3d T_reference_model = Eigen::Isometry3d::Identity();
  int iterations = 0;
  bool converged = false;
};

/// Places points on a surface. Without `T_start` anywhere: trimmed ICP (Chetverikov et al. 2005) from evenly spread
/// orientations (super-Fibonacci spirals, Alexa 2022) on few points, the best refined on more and the closest fit kept,
/// so that a symmetric shape lands in one of its equal poses. Then, or from `T_start` at once, ICP on the triangles
/// with Tukey weights whose width follows the median distance. Deterministic on any number of threads.
RegistrationResult registerToSurface(const std::vector<Eigen::Vector3d>& points_model,
                                     const mesh::ReferenceSurface& surface,
                                     const std::optional<Eigen::Isometry3d>& T_start,
                                     const RegistrationOptions& options, base::JobControl& control);

}  // namespace object_modelling::evaluation
