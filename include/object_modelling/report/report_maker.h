#pragma once

#include <string>

#include "object_modelling/base/job_control.h"

namespace object_modelling::report
{
/// Makes report.html of an object's folder (docs/report.md) by the Python program object_report, which is looked for
/// beside the running program, then in PATH. Throws base::Error with the reason (NOT_FOUND: the program; INTERNAL: it
/// failed, with the last line of its output; TIMEOUT: after a minute), Cancelled. An earlier report is kept then.
void makeReport(const std::string& object_folder, base::JobControl& control);

}  // namespace object_modelling::report
