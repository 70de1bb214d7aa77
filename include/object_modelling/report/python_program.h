#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"

namespace object_modelling::report
{
/// What a program left behind.
struct ProgramResult
{
  int exit_code = 0;
  std::string output;           ///< its stdout
  std::string last_error_line;  ///< of its stderr, which is where Python says what was wrong
};

/// Runs one of the package's Python programs (scripts/), which is looked for beside the running program, then in PATH.
/// Throws base::Error (NOT_FOUND: the program; INTERNAL: it cannot be run; TIMEOUT), Cancelled; it has ended then.
ProgramResult runPythonProgram(const std::string& program, const std::vector<std::string>& arguments,
                               std::chrono::seconds timeout, base::JobControl& control);

}  // namespace object_modelling::report
