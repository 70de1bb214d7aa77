#pragma once

#include <optional>
#include <vector>

#include "object_modelling/evaluation/registration.h"

namespace object_modelling::evaluation
{
constexpr double OUTLIER_DISTANCE_M = 0.005;

/// Metres; of distances, which have no sign.
struct DistanceStatistics
{
  double mean_m = 0, sigma_m = 0, rms_m = 0;
  double median_m = 0, p95_m = 0, max_m = 0;
  double outlier_ratio = 0;  ///< share beyond OUTLIER_DISTANCE_M
};

/// All 0 without distances.
DistanceStatistics statisticsOf(const std::vector<double>& distances_m);

struct ComparisonOptions
{
  RegistrationOptions registration;
  bool align = true;                         ///< false: measured as `T_start` places the model
  std::optional<Eigen::Isometry3d> T_start;  ///< T_reference_model known roughly; the search is left out
  double max_size_ratio = 100;               ///< sizes that differ by more are taken for a mistake of units
  std::vector<std::string> violations() const;
};

struct Comparison
{
  base::Status status;  ///< BAD_INPUT: units that cannot be; NO_RESULT: no pose found
  Eigen::Isometry3d T_reference_model = Eigen::Isometry3d::Identity();
  bool converged = true;                          ///< of the alignment
  std::vector<Eigen::Vector3d> points_reference;  ///< the model's points, placed
  std::vector<double> distances_m;                ///< of each to the reference's triangles
  DistanceStatistics statistics;
  double model_diagonal_m = 0, reference_diagonal_m = 0;  ///< of the boxes along the axes of either frame
};

/// The measure of Aldoma et al. 2015, section 4: the model is registered to a reference (there a laser scan), then the
/// distances of its points to the reference's surface are taken. It measures the accuracy of the model's surface,
/// not its completeness.
Comparison compareToReference(const std::vector<Eigen::Vector3d>& points_model, const mesh::ReferenceSurface& surface,
                              const ComparisonOptions& options, base::JobControl& control);

}  // namespace object_modelling::evaluation
