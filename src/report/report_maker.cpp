#include "object_modelling/report/report_maker.h"

#include "object_modelling/report/python_program.h"

namespace object_modelling::report
{
namespace
{
constexpr char PROGRAM[] = "object_report";
constexpr std::chrono::seconds TIMEOUT{ 60 };
}  // namespace

void makeReport(const std::string& object_folder, base::JobControl& control)
{
  const ProgramResult result = runPythonProgram(PROGRAM, { object_folder }, TIMEOUT, control);
  if (result.exit_code != 0)
    throw base::Error(base::StatusCode::INTERNAL, std::string(PROGRAM) + " failed: " + result.last_error_line);
}

}  // namespace object_modelling::report
