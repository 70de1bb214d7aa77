#pragma once

#include <nlohmann/json.hpp>

#include "refinement_measure.h"

namespace object_modelling::benchmark_refinement
{
std::string tableHeader();
std::string toRow(const std::string& recording, const Measurement& measurement);
nlohmann::json toJson(const std::string& recording, const Measurement& measurement);

}  // namespace object_modelling::benchmark_refinement
