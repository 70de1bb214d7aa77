#pragma once

#include <string>

#include <object_modelling/EncodedKeyframe.h>
#include <object_modelling/Keyframe.h>
#include <object_modelling/ObjectMask.h>

#include "object_modelling/keyframes/session_store.h"
#include "object_modelling/rgbd/keyframe.h"

namespace object_modelling::ros_bridge
{
object_modelling::Keyframe toMessage(const rgbd::Keyframe& keyframe, const std::string& session_id,
                                     const std::string& camera_frame_id);
/// Throws base::Error (BAD_INPUT, INVALID_ARGUMENT) for parts that cannot be used: sizes that differ, no intrinsics.
rgbd::Keyframe fromMessage(const object_modelling::Keyframe& message);

object_modelling::EncodedKeyframe toMessage(const keyframes::EncodedKeyframe& keyframe);
keyframes::EncodedKeyframe fromMessage(const object_modelling::EncodedKeyframe& message);

object_modelling::ObjectMask toMessage(const keyframes::MaskUpdate& update, const std::string& session_id);
keyframes::MaskUpdate fromMessage(const object_modelling::ObjectMask& message);

}  // namespace object_modelling::ros_bridge
