#include "keyframe_store_options.h"

#include "../common/frame_parameters.h"

namespace object_modelling::nodes
{
std::vector<std::string> KeyframeStoreOptions::violations() const
{
  base::OptionsCheck check("keyframe_store");
  check.inRange("preview_rate_hz", preview_rate_hz, 0.1, 30.0);
  requireFrameId(check, "session_frame_id", session_frame_id);
  check.include(preview.violations());
  return check.violations();
}

}  // namespace object_modelling::nodes
