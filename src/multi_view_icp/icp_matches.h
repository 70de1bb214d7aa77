#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "icp_view.h"
#include "nearest_points.h"

namespace object_modelling::multi_view_icp
{
/// How partners are found and weighed at one stage, from coarse to fine.
struct IcpStage
{
  double gate_m = 0;  ///< errors of the poses move points by about as much; 0: noise alone
  double min_normal_cosine = 0;
  int color_level = 0;
  int point_step = 1;  ///< every so many of a view's points
  /// Depth ends a little within the rim of an object. Of views from all sides these errors cancel; of an object that
  /// was turned over each session sees a rim from its own side, and is pulled one way.
  bool rims = true;
};

/// A point of view b and the plane of view a that it belongs to, each in its camera's frame.
struct SurfaceMatch
{
  Eigen::Vector3f p_b, p_a, n_a;
  float noise_m = 1;  ///< sigma of the distance
  float sigma_m = 1;  ///< the same with what the poses may be off
};

/// A point of view b, and its grey level as a's exposure shows it.
struct ColorMatch
{
  Eigen::Vector3f p_b;
  float intensity = 0;
};

/// What ties b to a: its points in a.
struct IcpMatches
{
  std::vector<SurfaceMatch> surface;
  std::vector<ColorMatch> color;
  float color_sigma = 1;  ///< grey levels
  int in_view = 0;        ///< points that a should see by the poses
  int fitting = 0;        ///< those of them whose partner lies within noise
};

/// Of the surfaces alone, without rims and colours. `nearest`: of a, for IcpAssociation::NEAREST; else null.
IcpMatches matchSurface(const IcpView& a, const IcpView& b, const Eigen::Isometry3d& T_a_b, const IcpStage& stage,
                        const NearestPoints* nearest);

/// Of all that ties b to a.
IcpMatches matchViews(const IcpView& a, const IcpView& b, const Eigen::Isometry3d& T_a_b, const IcpStage& stage,
                      const NearestPoints* nearest);

}  // namespace object_modelling::multi_view_icp
