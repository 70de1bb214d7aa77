#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/report/quality_report.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::pipeline
{
/// The sessions of one build, everything in the reference frame.
struct Views
{
  std::vector<keyframes::Session> sessions;
  std::vector<rgbd::View> views;            ///< of keyframes that see the object; their world is the reference frame
  std::vector<report::ViewOrigin> origins;  ///< of each of them
  std::vector<std::string> warnings;        ///< of keyframes that are left out
  std::vector<geometry::Plane> support_planes_reference;  ///< of each session that has one

  std::optional<geometry::Plane> firstSupport() const;
  /// What the object of a single session stood on. Of several, each saw what another one stood on.
  std::optional<geometry::Plane> onlySupport() const;
};

/// FAILED_PRECONDITION for a session without keyframes or masks.
base::Status loadViews(keyframes::SessionStore& store, const std::vector<alignment::SessionPlacement>& placements,
                       base::JobControl& control, Views* views);

}  // namespace object_modelling::pipeline
