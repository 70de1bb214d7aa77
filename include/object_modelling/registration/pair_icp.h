#pragma once

#include "object_modelling/registration/matched_surface.h"

namespace object_modelling::registration
{
enum class ColorDetail
{
  NONE,
  BLURRED,
  SHARP
};

struct PairIcpOptions
{
  bool coarse = true;    ///< far reach and few points, b on a only; else near, many, and both ways
  double gate_m = 0.02;  ///< at the start; shrinks to `last_gate_m`
  double last_gate_m = 0.005;
  int iterations = 8;  ///< over which the gate shrinks
  ColorDetail color = ColorDetail::NONE;
};

/// Point-to-plane ICP of part b on part a (Chen and Medioni 1992), with the colours of the surface where asked for
/// (after Park, Zhou, Koltun 2017). Directions that the surfaces leave free
/// are not changed, except those that the other's support plane constrains, unless coarse.
Eigen::Isometry3f alignByIcp(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b,
                             const PairIcpOptions& options);

}  // namespace object_modelling::registration
