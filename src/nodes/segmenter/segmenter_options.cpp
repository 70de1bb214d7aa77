#include "segmenter_options.h"

#include "../common/frame_parameters.h"

namespace object_modelling::nodes
{
std::vector<std::string> SegmenterOptions::violations() const
{
  base::OptionsCheck check("segmenter");
  check.inRange("preview_rate_hz", preview_rate_hz, 0.0, 30.0);
  check.inRange("selection_margin_m", selection_margin_m, 0.0, 1.0);
  check.inRange("tf_timeout_s", tf_timeout_s, 0.0, 5.0);
  requireFrameId(check, "session_frame_id", session_frame_id);
  check.include(frame.violations());
  check.include(propagator.violations());
  return check.violations();
}

}  // namespace object_modelling::nodes
