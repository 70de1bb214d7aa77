#pragma once

#include <yaml-cpp/yaml.h>

#include "object_modelling/report/refinement_report.h"

namespace object_modelling::report
{
/// A map, as the session's report and quality.yaml have it.
void emit(YAML::Emitter& out, const RefinementReport& report);

}  // namespace object_modelling::report
