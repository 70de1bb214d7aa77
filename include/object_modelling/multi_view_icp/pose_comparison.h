#pragma once

#include <cstdint>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::multi_view_icp
{
/// How far apart the images of views are at given poses. Robust means of squares: 0 for images that agree within
/// noise, about 1 for some sigmas.
struct PoseScore
{
  double depth = 0;    ///< of depths, in sigmas of the noise model
  double gray = 0;     ///< of grey levels, in GRAY_SIGMA
  int pair_count = 0;  ///< of views that see the same surface; 0: nothing is known
  double total() const { return depth + gray; }
};

/// Poses of the views by one refinement, in the order of the views; they replace the poses stored there.
struct PoseSet
{
  std::vector<Eigen::Isometry3d> T_world_camera;
  Eigen::Vector2d color_offset_px = Eigen::Vector2d::Zero();  ///< of all views
};

struct PoseComparisonOptions
{
  bool object_only = false;  ///< only what is on the object masks
  int samples_per_keyframe = 400;
  double min_overlap_ratio = 0.25;  ///< of the samples of one view that another must see, to count as a pair
  std::uint64_t seed = 1;
};

/// Compares sets of poses of the same views by pixels that are drawn at random, of which the refinements used next
/// to none, over all pairs of views (at most 100 for each), of which they used few: what fits better there is not
/// only fitted better. Each set is judged on the same pixels. One score per set. Throws base::Cancelled.
std::vector<PoseScore> comparePoses(const std::vector<rgbd::View>& views, const std::vector<PoseSet>& sets,
                                    const PoseComparisonOptions& options, base::JobControl& control);

}  // namespace object_modelling::multi_view_icp
