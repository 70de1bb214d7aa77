#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

// What the programs here have in common.
namespace object_modelling::benchmark_program
{
/// Parses the command line and works; the exit code: 0, 1 (failed; the reason on stderr), 2 (wrong usage).
int run(CLI::App& app, int argc, char** argv, const std::function<void()>& work);

/// Nothing if `path` is empty. Throws base::Error (STORAGE).
void writeJson(const std::string& path, const nlohmann::json& json);

}  // namespace object_modelling::benchmark_program
