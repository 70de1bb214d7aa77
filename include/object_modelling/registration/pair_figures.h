#pragma once

#include <vector>

#include "object_modelling/registration/pair_quality.h"

namespace object_modelling::registration
{
/// One figure of a PairQuality by its name, as files and reports have it.
struct PairFigure
{
  const char* name;
  double PairQuality::*value;
  bool required = true;  ///< older records lack what was added since: its default
};

/// All of them, in the order of PairQuality.
const std::vector<PairFigure>& pairFigures();

}  // namespace object_modelling::registration
