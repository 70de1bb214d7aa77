#include "object_modelling/keyframes/session_change.h"

#include <utility>

namespace object_modelling::keyframes
{
SessionChange SessionChange::ofPoses(std::vector<PoseUpdate> updates)
{
  SessionChange change;
  change.poses = std::move(updates);
  return change;
}

SessionChange SessionChange::ofMasks(std::vector<MaskUpdate> updates)
{
  SessionChange change;
  change.masks = std::move(updates);
  return change;
}

SessionChange SessionChange::toAllOf(const Session& session)
{
  SessionChange change;
  change.object_id = session.object_id;
  change.reference_is_object = session.reference_is_object;
  change.closed = session.closed;
  change.support_plane_session = session.support_plane_session;
  change.T_model_session = session.T_model_session;
  change.calibration = session.calibration;
  change.refinement_report = session.refinement_report;
  change.refined = session.refined;
  change.segmented = session.segmented;
  return change;
}

}  // namespace object_modelling::keyframes
