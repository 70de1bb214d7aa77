#include "recogniser_options.h"

namespace object_modelling::nodes
{
std::vector<std::string> RecogniserNodeOptions::violations() const
{
  base::OptionsCheck check("recogniser");
  check.inRange("rate_hz", rate_hz, 0.0, 30.0);
  check.inRange("input_timeout_s", input_timeout_s, 0.0, 60.0);
  check.inRange("poll_period_s", poll_period_s, 0.1, 3600.0);
  check.include(frame.violations());
  check.include(recogniser.violations());
  return check.violations();
}

}  // namespace object_modelling::nodes
