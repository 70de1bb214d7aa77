#pragma once

#include <functional>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "object_modelling/base/job_control.h"
#include "object_modelling/base/status.h"
#include "object_modelling/pipeline/record_session.h"
#include "object_modelling/pipeline/session_refinement.h"

namespace object_modelling::cli
{
/// Output of a command: `text` for people, `json` for programs; one of them is printed on stdout.
struct CommandOutput
{
  std::string text;
  nlohmann::json json;
  base::Status status{};  ///< of a failure whose figures are worth printing all the same
  std::string warning{};  ///< printed on stderr: the command did its work, but not all that was hoped for
};

/// A parsed subcommand, ready to run. Throws base::Error.
using Command = std::function<CommandOutput(base::JobControl& control)>;

/// Each adds one subcommand to `app`, and sets `*chosen` when that one has been parsed.
void addTrackCommand(CLI::App& app, Command* chosen);
void addAlignCommand(CLI::App& app, Command* chosen);
void addModelCommand(CLI::App& app, Command* chosen);
void addCalibrateNoiseCommand(CLI::App& app, Command* chosen);
void addCalibrateCameraCommand(CLI::App& app, Command* chosen);
void addInfoCommand(CLI::App& app, Command* chosen);
void addReportCommand(CLI::App& app, Command* chosen);
void addExportCommand(CLI::App& app, Command* chosen);
void addCompareCommand(CLI::App& app, Command* chosen);
void addRecogniseCommand(CLI::App& app, Command* chosen);
void addImportMeshCommand(CLI::App& app, Command* chosen);
void addDatabaseCommands(CLI::App& app, Command* chosen);  ///< check, migrate, delete
void addIdentityCommands(CLI::App& app, Command* chosen);  ///< rename, merge

/// Options that track and model share.
struct RecordArguments
{
  bool object_reference = false;
  std::uint64_t seed = 1;
  std::string noise_model;  ///< path; empty: the default
  pipeline::RefinementMethod refinement = pipeline::RefinementOptions().method;
};
void addTrackingOptions(CLI::App& command, RecordArguments* arguments);  ///< all but --refinement
void addRecordOptions(CLI::App& command, RecordArguments* arguments);
pipeline::RecordOptions recordOptions(const RecordArguments& arguments);
pipeline::RefinementOptions refinementOptions(const RecordArguments& arguments);

/// Before work whose result goes to a file: INVALID_ARGUMENT if it cannot be written there.
void requireOutputFolder(const std::string& path);

/// A session id from the name of a recording: its last path component with everything unusual replaced by '_'.
std::string sessionIdFrom(const std::string& recording);

}  // namespace object_modelling::cli
