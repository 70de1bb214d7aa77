#pragma once

#include <Eigen/Geometry>

#include "object_modelling/geometry/normal_equations.h"
#include "object_modelling/registration/dense_pyramid.h"

namespace object_modelling::registration
{
struct DenseAlignmentOptions
{
  /// Neighbouring pixels err alike (interpolation, calibration, smooth distortion of depth): this many of them, at the
  /// finest level for depth, weigh as much as one independent measurement.
  double correlated_depths = 120;
  double correlated_intensities = 10;  ///< likewise, for intensities on edges
  int max_iterations = 8;              ///< per level
  /// Levels used, 0: the finest. From coarsest to finest; the same for a start that is good already.
  int coarsest_level = 2;
  int finest_level = 0;
};

/// What one evaluation of the dense term found.
struct DenseTerm
{
  geometry::NormalEquations equations;
  int in_view = 0;             ///< reference points that project into the frame and are not hidden
  double depth_agreement = 0;  ///< share of those with depth whose depth the frame confirms, in [0, 1]
  double overlap = 0;          ///< share of the reference's points that are in view, in [0, 1]
  double correlation = 0;      ///< of the intensities on edges and texture, in [-1, 1]
  double intensity_scale = 0;  ///< robust standard deviation of the intensity residuals, grey levels
};

/// Point-to-plane depth and photometric residuals of a reference's points in a frame at one level (Kerl, Sturm, Cremers
/// 2013; Chen & Medioni 1992), each weighed by its robust scale. `T_camera_world` is what the motion of the
/// equations is applied to; `T_world_reference` places the points.
DenseTerm evaluateDense(const DensePoints& points, const DenseLevel& level, const Eigen::Isometry3d& T_camera_world,
                        const Eigen::Isometry3d& T_world_reference, const DenseAlignmentOptions& options);

struct DenseAlignment
{
  bool converged = false;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< where `term` was evaluated
  DenseTerm term;                                                    ///< at the finest level used
};

/// Coarse to fine Gauss-Newton from a start that may be several degrees off. `prior` (information about
/// T_world_camera_start, in the order of the normal equations) constrains what neither depth nor intensity do.
DenseAlignment alignDense(const DenseReference& reference, const Eigen::Isometry3d& T_world_reference,
                          const DensePyramid& frame, const Eigen::Isometry3d& T_world_camera_start,
                          const geometry::Matrix6d& prior, const DenseAlignmentOptions& options = {});

}  // namespace object_modelling::registration
