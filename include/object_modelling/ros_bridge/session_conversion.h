#pragma once

#include <object_modelling/AlignmentRecord.h>
#include <object_modelling/Session.h>
#include <object_modelling/SessionChange.h>

#include "object_modelling/keyframes/alignment_record.h"
#include "object_modelling/keyframes/session_change.h"

namespace object_modelling::ros_bridge
{
object_modelling::Session toMessage(const keyframes::Session& session);
/// Throws base::Error (INVALID_ARGUMENT) for an unusable pose or plane. Ids are checked by the store.
keyframes::Session fromMessage(const object_modelling::Session& message);

object_modelling::SessionChange toMessage(const keyframes::SessionChange& change);
/// Throws base::Error (INVALID_ARGUMENT) for an unusable pose, mask or plane among what is set.
keyframes::SessionChange fromMessage(const object_modelling::SessionChange& message);

object_modelling::AlignmentRecord toMessage(const keyframes::AlignmentRecord& record);
keyframes::AlignmentRecord fromMessage(const object_modelling::AlignmentRecord& message);

}  // namespace object_modelling::ros_bridge
