#pragma once

#include <vector>

#include "observation.h"
#include "prepared_view.h"

namespace object_modelling::fusion
{
/// How the views agree with a surface point, each by the depth it measured where the point projects.
struct Votes
{
  int same = 0;          ///< sees a surface there
  int seen_through = 0;  ///< sees a surface clearly behind: the point is not there
  int object = 0;        ///< of `same`: inside its mask
  int background = 0;    ///< of `same`: outside its mask

  /// Whether the views that see through weigh more. One wrong view (a bad pose, a flying pixel behind the object) does
  /// not outvote two right ones.
  bool outvoted() const { return 2 * seen_through > same; }
};

/// A measured surface point, and how far it may be off.
struct SurfacePoint
{
  Eigen::Vector3f point, normal;
  Eigen::Vector3f farthest;  ///< where it may as well be: consistency_sigmas further along the ray that measured it
  float axial_sigma_m = 0;
};

/// Views that look at the point from behind its normal vote only if they see through it. A view sees through only
/// if it does so all the way to `farthest`: else noise that moves a point off the object's silhouette would be cut off
/// on the outside and left on the inside, and the object would shrink.
Votes castVotes(const std::vector<PreparedView>& views, const SurfacePoint& surface, double consistency_sigmas,
                int own_view = -1);

/// Removes the observations that other views see through, more of them than uphold them; returns how many went.
std::size_t removeSeenThrough(const std::vector<PreparedView>& views, double consistency_sigmas,
                              std::vector<std::vector<Observation>>* observations_per_view);

}  // namespace object_modelling::fusion
