// Time and size of writing one object: benchmark_object_database <number of views> <database folder>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "model_fixtures.h"
#include "object_modelling/database/object_database.h"

int main(int argc, char** argv)
{
  using namespace object_modelling;
  if (argc != 3)
    return 2;
  const database::ObjectModel model = database::makeModel("benchmark", 0, std::atoi(argv[1]));
  database::ObjectDatabase database(argv[2], true);
  base::JobControl control;
  const auto timed = [](const char* name, const std::function<void()>& call)
  {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    call();
    std::cout << name << ": " << std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()
              << " s, CPU " << static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC << " s\n";
  };
  timed("write", [&] { database.write(model, control); });
  timed("replace", [&] { database.write(model, control); });
  timed("list", [&] { database.list(); });
  timed("check", [&] { database.check(); });
  std::uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(database.root()))
    bytes += entry.is_regular_file() ? entry.file_size() : 0;
  std::cout << bytes / 1000000 << " MB\n";
}
