#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session_store.h"
#include "quality_report.h"

namespace object_modelling::pipeline
{
/// The sessions of one build, everything in the reference frame.
struct Views
{
  std::vector<keyframes::Session> sessions;
  std::vector<rgbd::Keyframe> keyframes;  ///< those that see the object; T_session_camera holds T_reference_camera
  std::vector<ViewOrigin> origins;        ///< of each of them
  /// The lamps stay where they are while the object is turned over: every session is under a light of its own.
  std::vector<int> lights;
  std::vector<geometry::Plane> support_planes_reference;  ///< of each session that has one

  std::optional<geometry::Plane> firstSupport() const;
  /// What the object of a single session stood on. Of several, each saw what another one stood on.
  std::optional<geometry::Plane> onlySupport() const;
  /// Sessions of one camera have one shift, but for errors.
  Eigen::Vector2d meanColorOffset_px() const;
};

/// FAILED_PRECONDITION for a session without keyframes or masks.
base::Status loadViews(keyframes::SessionStore& store, const std::vector<alignment::SessionPlacement>& placements,
                       base::JobControl& control, Views* views);

}  // namespace object_modelling::pipeline
