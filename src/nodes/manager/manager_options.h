#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/options.h"

namespace object_modelling::nodes
{
struct ManagerOptions
{
  double service_wait_s = 5;   ///< for a service or action to be offered
  double call_timeout_s = 60;  ///< for the answer of a service
  double job_silence_s = 10;   ///< of a node that works on a job, until it counts as gone

  std::vector<std::string> violations() const
  {
    base::OptionsCheck check("modelling_manager");
    check.inRange("service_wait_s", service_wait_s, 0.1, 3600.0);
    check.inRange("call_timeout_s", call_timeout_s, 0.1, 3600.0);
    check.inRange("job_silence_s", job_silence_s, 0.1, 3600.0);
    return check.violations();
  }
};

template <typename Reader>
void read(Reader& reader, ManagerOptions* options)
{
  reader.read("service_wait_s", options->service_wait_s);
  reader.read("call_timeout_s", options->call_timeout_s);
  reader.read("job_silence_s", options->job_silence_s);
}

}  // namespace object_modelling::nodes
