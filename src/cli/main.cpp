#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>

#include <glog/logging.h>

#include "command.h"
#include "progress_line.h"
#include "report_text.h"

namespace
{
using namespace object_modelling;

constexpr int EXIT_FAILED = 1;
constexpr int EXIT_USAGE = 2;
constexpr int EXIT_INTERRUPTED = 130;

base::JobControl* running_job = nullptr;

// JobControl::cancel() only stores to an atomic, which a signal handler may do.
void cancelRunningJob(int)
{
  running_job->cancel();
}

/// While it lives, what libraries print on stdout (PCL's Poisson does) goes to stderr: stdout is for results alone.
class StdoutToStderr
{
public:
  StdoutToStderr() : stdout_(dup(STDOUT_FILENO)) { dup2(STDERR_FILENO, STDOUT_FILENO); }
  ~StdoutToStderr()
  {
    std::fflush(stdout);
    dup2(stdout_, STDOUT_FILENO);
    close(stdout_);
  }

private:
  int stdout_;
};

cli::CommandOutput runQuietly(const cli::Command& command, base::JobControl& control)
{
  const StdoutToStderr guard;
  return command(control);
}

int execute(const cli::Command& command, bool json, bool quiet)
{
  cli::ProgressLine line(!quiet);
  base::JobControl control([&line](const base::Progress& progress) { line.show(progress); });
  running_job = &control;
  std::signal(SIGINT, cancelRunningJob);
  std::signal(SIGTERM, cancelRunningJob);
  base::Status status;
  try
  {
    const cli::CommandOutput output = runQuietly(command, control);
    std::cout << (json ? output.json.dump(2) + "\n" : output.text) << std::flush;
    if (!output.warning.empty())
      std::cerr << "\nobject_modelling: WARNING: " << output.warning << std::endl;
    if (output.status.ok())
      return 0;
    status = output.status;
    json = false;  // already printed
  }
  catch (const base::Error& error)
  {
    status = error.status();
  }
  catch (const std::exception& error)
  {
    status = { base::StatusCode::INTERNAL, error.what() };
  }
  if (json)
    std::cout << nlohmann::json{ { "status", cli::toJson(status) } }.dump(2) << std::endl;
  std::cerr << "\nobject_modelling: " << status.message << std::endl;
  return status.code == base::StatusCode::CANCELLED ? EXIT_INTERRUPTED : EXIT_FAILED;
}
}  // namespace

int main(int argc, char** argv)
{
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;

  CLI::App app("Object models from recordings of a handheld RGB-D camera, without a ROS master.");
  app.require_subcommand(1);
  app.fallthrough();
  bool json = false;
  bool quiet = false;
  app.add_flag("--json", json, "Print the result as JSON on stdout");
  app.add_flag("--quiet", quiet, "No progress on stderr");
  app.footer(
      "Exit codes: 0 done (a warning on stderr tells what could not be), 1 failed (the reason is on stderr), 2 wrong "
      "command line, 130 interrupted.\n"
      "A recording is a TUM-style folder (rgb.txt, depth.txt, camera.yaml) or a ROS bag.");
  cli::Command command;
  cli::addTrackCommand(app, &command);
  cli::addModelCommand(app, &command);
  cli::addAlignCommand(app, &command);
  cli::addCalibrateNoiseCommand(app, &command);
  cli::addCalibrateCameraCommand(app, &command);
  cli::addInfoCommand(app, &command);
  cli::addReportCommand(app, &command);
  cli::addExportCommand(app, &command);
  cli::addCompareCommand(app, &command);
  cli::addRecogniseCommand(app, &command);
  cli::addImportMeshCommand(app, &command);
  cli::addDatabaseCommands(app, &command);
  cli::addIdentityCommands(app, &command);
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error)
  {
    return app.exit(error) == 0 ? 0 : EXIT_USAGE;
  }
  return execute(command, json, quiet);
}
