#include "object_modelling/report/python_program.h"

#include <algorithm>
#include <csignal>
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

constexpr std::chrono::milliseconds POLL_INTERVAL{ 20 };
constexpr std::size_t MAX_LINE_LENGTH = 2000;

fs::path folderOfThisProgram()
{
  std::error_code failure;
  const fs::path executable = fs::read_symlink("/proc/self/exe", failure);
  return failure ? fs::path() : executable.parent_path();
}

std::string findProgram(const std::string& program, const fs::path& own_folder)
{
  std::error_code ignored;
  if (!own_folder.empty() && fs::is_regular_file(own_folder / program, ignored))
    return (own_folder / program).string();
  std::string found = process::search_path(program).string();
  if (found.empty())
    throw Error(StatusCode::NOT_FOUND,
                "the program '" + program + "' is neither beside this one nor in PATH; is the package installed?");
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

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporaryFile()
{
  File file(std::tmpfile(), std::fclose);
  if (!file)
    throw Error(StatusCode::STORAGE, "no temporary file can be made; is the disk full?");
  return file;
}

std::string contentsOf(std::FILE* file)
{
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file))
    text.push_back(static_cast<char>(c));
  return text;
}

std::string lastLine(const std::string& text)
{
  const std::size_t end = text.find_last_not_of('\n');
  if (end == std::string::npos)
    return {};
  const std::size_t before = text.find_last_of('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text.substr(begin, std::min<std::size_t>(end + 1 - begin, MAX_LINE_LENGTH));
}

void waitFor(process::child& child, const std::string& program, std::chrono::seconds timeout, base::JobControl& control)
{
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (child.running())
  {
    const bool late = std::chrono::steady_clock::now() > deadline;
    if (late || control.cancelled())
    {
      kill(child.id(), SIGTERM);  // so that it can tidy up
      child.wait();
      control.checkCancelled();
      throw Error(StatusCode::TIMEOUT, program + " did not end within " + std::to_string(timeout.count()) + " s");
    }
    std::this_thread::sleep_for(POLL_INTERVAL);
  }
  child.wait();
  control.checkCancelled();  // a terminal's Ctrl-C ends both
}
}  // namespace

ProgramResult runPythonProgram(const std::string& program, const std::vector<std::string>& arguments,
                               std::chrono::seconds timeout, base::JobControl& control)
{
  control.checkCancelled();
  const fs::path own_folder = folderOfThisProgram();
  const std::string path = findProgram(program, own_folder);
  const File output = temporaryFile(), errors = temporaryFile();
  try
  {
    process::child child(process::exe = path, process::args = arguments,
                         process::std_in<process::null, process::std_out> output.get(), process::std_err > errors.get(),
                         environmentFor(own_folder));
    waitFor(child, program, timeout, control);
    return { child.exit_code(), contentsOf(output.get()), lastLine(contentsOf(errors.get())) };
  }
  catch (const process::process_error& error)
  {
    throw Error(StatusCode::INTERNAL, path + " cannot be run: " + error.what());
  }
}

}  // namespace object_modelling::report
