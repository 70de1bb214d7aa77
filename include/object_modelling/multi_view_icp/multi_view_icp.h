#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::multi_view_icp
{
/// How a point finds its partner on the surface that another view sees.
enum class IcpAssociation
{
  PROJECTIVE,  ///< along the viewing ray, searched round it while poses are poor
  NEAREST      ///< nearest point (k-d tree); slower, and less exact (docs/refinement.md)
};

struct MultiViewIcpOptions
{
  bool object_only = false;  ///< only what is on the object masks; views without one are left out
  /// How far points may be off at the start. The gate begins there and is halved until only noise is left.
  double start_error_m = 0.03;
  IcpAssociation association = IcpAssociation::PROJECTIVE;
  int points_per_keyframe = 1500;  ///< evenly over the directions of the normals, and as many on grey-level edges
  int max_partners = 6;            ///< views that each is aligned with
  double min_overlap_ratio = 0.25;
  double max_view_angle_rad = 0.87;    ///< 50 deg between the rays from two views to what both see
  double max_normal_angle_rad = 0.52;  ///< 30 deg between the normals of partners, once poses are good
  double min_edge_distance_px = 1.5;   ///< to depth edges, in images of at most 320 px width
  double loss_width_sigmas = 2.385;    ///< Cauchy: 95 % efficient for normal errors
  /// Weight of grey levels against depths, 0: geometry alone. They constrain what the shape leaves free (a can, a
  /// table).
  double color_weight = 1;
  /// Views of one session keep their poses relative to each other and move as one body (sessions that were refined by
  /// themselves, on more than the object). Partners are views of other sessions that have surface in common as they
  /// come in, however different the directions from which they see it; a body moves along those motions alone that
  /// more than noise resists. Otherwise each view moves by itself.
  bool sessions_as_bodies = false;
  int max_iterations = 60;  ///< associations, over all gates
  int threads = 2;          ///< any number gives the same bits
  std::vector<std::string> violations() const;
};

/// Over the partners of the last association, the same ones before and after.
struct IcpViewResidual
{
  int point_count = 0;                         ///< pairs of points with this view, both directions
  double rmse_before_m = 0, rmse_after_m = 0;  ///< point to plane, each weighed as in the estimate
  double inlier_ratio = 0;                     ///< share of the points in view that fit within noise
};

/// Two views, by index, that were aligned with each other.
struct IcpPair
{
  int view_a = -1, view_b = -1;
  double overlap_ratio = 0;  ///< predicted at the start: share of the surface of one that the other sees
  int point_count = 0;
  double rmse_before_m = 0, rmse_after_m = 0;  ///< point to plane
};

/// A motion of one view against the first that neither surfaces nor grey levels resist, e.g. about the axis of a
/// sphere on a table: the pose along it is what came in, moved by noise.
struct FreeDirection
{
  int view = -1;                                                  ///< index
  bool rotation = false;                                          ///< else a translation
  Eigen::Vector3d axis_world = Eigen::Vector3d::Zero();           ///< unit vector
  Eigen::Vector3d point_on_axis_world = Eigen::Vector3d::Zero();  ///< of a rotation
};

struct MultiViewIcpResult
{
  /// NO_RESULT: nothing overlaps, or not converged; poses are then those that came in. Bodies that have not converged
  /// are OK: they have the poses of least error; last_step_m and last_step_rad give the last change.
  base::Status status;
  std::vector<Eigen::Isometry3d> T_world_camera;  ///< per view, in the order given
  std::vector<geometry::Matrix6d> covariance;     ///< likewise; that which came in for the fixed one and those left out
  std::vector<IcpViewResidual> residuals;         ///< likewise
  std::vector<IcpPair> pairs;
  std::vector<int> left_out;  ///< indices of views that overlap with no other, or do not fit; poses unchanged
  std::vector<FreeDirection> free_directions;
  std::vector<double> rmse_m;  ///< point to plane, of each iteration: the gate narrows on the way
  int iterations = 0;
  /// What the last iteration still did: how far it moved what a view sees, and turned a view, at most.
  double last_step_m = 0, last_step_rad = 0;
  bool converged = false;
};

/// Aligns all views with each other at once, those of one session or of several, without need of texture: each
/// overlapping pair is a set of robustly weighted point-to-plane residuals, with the sigma of the noise model, and of
/// grey levels; all poses but the first are solved for together by Levenberg-Marquardt on the sparse normal equations,
/// and partners are found anew (in aim after Fantoni, Castellani, Fusiello, Accurate and Automatic Alignment of Range
/// Surfaces, 3DIMPVT 2012; residuals after Chen and Medioni 1992, points after Rusinkiewicz and Levoy 2001). Throws
/// base::Error (INVALID_ARGUMENT) for bad options, base::Cancelled.
MultiViewIcpResult refineByMultiViewIcp(const std::vector<rgbd::View>& views, const MultiViewIcpOptions& options,
                                        base::JobControl& control);

}  // namespace object_modelling::multi_view_icp
