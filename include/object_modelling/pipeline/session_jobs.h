#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/bundle_adjustment/bundle_adjustment.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/segmentation/object_mask_propagator.h"

// The stages between recording and building, each on stored sessions: read, compute, write back in one transaction.
// A stage that fails or is cancelled leaves the store as it was. All throw base::Error for store errors.
namespace object_modelling::pipeline
{
struct SegmentReport
{
  base::Status status;
  std::string session_id;
  int keyframe_count = 0;
  int masked_count = 0;  ///< keyframes in which the object is in view
  bool support_plane_found = false;
};

/// Masks for all keyframes, and the support plane. `seed_point_session` names the object; without one it is chosen
/// automatically.
SegmentReport segmentStoredSession(keyframes::SessionStore& store, const std::string& session_id,
                                   const std::optional<Eigen::Vector3d>& seed_point_session,
                                   const segmentation::ObjectMaskPropagatorOptions& options, base::JobControl& control);

/// Bundle adjustment of one session; writes the poses and the colour offset back if it succeeded.
bundle_adjustment::BundleAdjustmentResult refineStoredSession(keyframes::SessionStore& store,
                                                              const std::string& session_id,
                                                              bundle_adjustment::BundleAdjustmentOptions options,
                                                              base::JobControl& control);

}  // namespace object_modelling::pipeline
