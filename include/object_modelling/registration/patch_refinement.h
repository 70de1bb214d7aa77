#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace object_modelling::registration
{
struct PatchRefinementOptions
{
  int max_iterations = 10;
  double convergence_px = 0.06;      ///< of the step, at the level's resolution
  double max_displacement_px = 5.0;  ///< from the start, at the level's resolution; beyond it is another feature
  double min_correlation = 0.75;     ///< normalised cross-correlation after convergence
  double coarse_start_px = 2.0;      ///< expected error of the start above which the half-resolution level goes first
};

struct PatchRefinement
{
  bool accepted = false;          ///< converged, near the start, and correlated
  Eigen::Vector2f pixel{ 0, 0 };  ///< sub-pixel, at full resolution
  float correlation = 0;          ///< normalised, in [-1, 1]
};

/// H = K (R + t n^T / (n^T X)) K^-1 of the plane through X with normal n, both in the reference camera's frame; R, t of
/// T_current_reference (Aldoma et al. 2015, section 3.1). Maps reference pixels to current pixels.
Eigen::Matrix3d patchHomography(const Eigen::Matrix3d& K, const Eigen::Matrix3d& R_current_reference,
                                const Eigen::Vector3d& t_current_reference, const Eigen::Vector3d& n_reference,
                                const Eigen::Vector3d& p_reference);

/// Finds the 15 x 15 patch round `reference_pixel` in the current image: it is warped by the homography once, then
/// shifted by Gauss-Newton with the mean of both images' gradients (symmetric KLT, Birchfield 1997), gain and bias
/// estimated along. `reference` and `current` are grey-level pyramids, full resolution first. `start_error_px` is how
/// far off `start` may be. Thread safe.
PatchRefinement refinePatch(const std::vector<cv::Mat>& reference, const std::vector<cv::Mat>& current,
                            const Eigen::Matrix3d& H_current_reference, const Eigen::Vector2f& reference_pixel,
                            const Eigen::Vector2f& start, double start_error_px,
                            const PatchRefinementOptions& options = {});

}  // namespace object_modelling::registration
