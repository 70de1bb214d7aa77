#include "benchmark_program.h"

#include <filesystem>
#include <fstream>
#include <iostream>

#include <glog/logging.h>

#include "object_modelling/base/status.h"

namespace object_modelling::benchmark_program
{
int run(CLI::App& app, int argc, char** argv, const std::function<void()>& work)
{
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_WARNING;
  try
  {
    app.parse(argc, argv);
    work();
  }
  catch (const CLI::ParseError& error)
  {
    return app.exit(error) == 0 ? 0 : 2;
  }
  catch (const base::Error& error)
  {
    std::cerr << std::filesystem::path(argv[0]).filename().string() << ": " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

void writeJson(const std::string& path, const nlohmann::json& json)
{
  if (path.empty())
    return;
  std::ofstream file(path);
  file << json.dump(1) << "\n";
  if (!file.flush())
    throw base::Error(base::StatusCode::STORAGE, "cannot write '" + path + "'");
}

}  // namespace object_modelling::benchmark_program
