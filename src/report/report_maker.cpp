#include "object_modelling/report/report_maker.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include <boost/process.hpp>

namespace object_modelling::report
{
namespace
{
namespace fs = std::filesystem;
namespace process = boost::process;
using base::Error;
using base::StatusCode;

constexpr char PROGRAM[] = "object_report";
constexpr std::chrono::seconds TIMEOUT{ 60 };
constexpr std::chrono::milliseconds POLL_INTERVAL{ 20 };

fs::path folderOfThisProgram()
{
  std::error_code failure;
  const fs::path executable = fs::read_symlink("/proc/self/exe", failure);
  return failure ? fs::path() : executable.parent_path();
}

std::string findProgram(const fs::path& own_folder)
{
  std::error_code ignored;
  if (!own_folder.empty() && fs::is_regular_file(own_folder / PROGRAM, ignored))
    return (own_folder / PROGRAM).string();
  std::string found = process::search_path(PROGRAM).string();
  if (found.empty())
    throw Error(StatusCode::NOT_FOUND, std::string("the program '") + PROGRAM +
                                           "' is neither beside this one nor in PATH; is the package installed?");
  return found;
}

/// Catkin keeps programs in lib/<package> and Python packages in lib/python3: found without its environment too.
process::environment environmentFor(const fs::path& own_folder)
{
  process::environment environment = boost::this_process::environment();
  const std::string packages = (own_folder.parent_path() / "python3" / "dist-packages").string();
  const char* before = std::getenv("PYTHONPATH");
  environment["PYTHONPATH"] = before != nullptr && *before != 0 ? std::string(before) + ":" + packages : packages;
  environment["PYTHONDONTWRITEBYTECODE"] = "1";
  return environment;
}

/// The last line, which is Python's error message.
std::string lastLine(std::FILE* file)
{
  std::rewind(file);
  std::string line, last;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file))
  {
    if (c != '\n')
      line.push_back(static_cast<char>(c));
    else if (!line.empty())
      last.swap(line), line.clear();
  }
  return (line.empty() ? last : line).substr(0, 500);
}
}  // namespace

void makeReport(const std::string& object_folder, base::JobControl& control)
{
  control.checkCancelled();
  const fs::path own_folder = folderOfThisProgram();
  const std::string program = findProgram(own_folder);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors(std::tmpfile(), std::fclose);
  if (!errors)
    throw Error(StatusCode::STORAGE, "no temporary file can be made; is the disk full?");
  try
  {
    process::child child(process::exe = program, process::args = { object_folder },
                         process::std_in<process::null, process::std_out> process::null,
                         process::std_err > errors.get(), environmentFor(own_folder));
    const auto deadline = std::chrono::steady_clock::now() + TIMEOUT;
    while (child.running())
    {
      const bool late = std::chrono::steady_clock::now() > deadline;
      if (late || control.cancelled())
      {
        child.terminate();
        child.wait();
        control.checkCancelled();
        throw Error(StatusCode::TIMEOUT, std::string(PROGRAM) + " did not end within a minute");
      }
      std::this_thread::sleep_for(POLL_INTERVAL);
    }
    child.wait();
    if (child.exit_code() != 0)
      throw Error(StatusCode::INTERNAL, std::string(PROGRAM) + " failed: " + lastLine(errors.get()));
  }
  catch (const process::process_error& error)
  {
    throw Error(StatusCode::INTERNAL, program + " cannot be run: " + error.what());
  }
}

}  // namespace object_modelling::report
