#pragma once

// Written by test/benchmark/evidence/alignment_evidence.py fit; docs/alignment.md. Not to be edited by hand.
// Fitted on 185 pairs, calibrated on 152.
namespace object_modelling::alignment
{
constexpr double WEIGHT_BIAS = 5.0921;  // +- 2.31
constexpr double WEIGHTS[] = {
  2.6179,   // overlap, +- 17.89
  0.6043,   // space, +- 0.71
  2.9675,   // through, +- 1.46
  1.5667,   // fit, +- 1.86
  0.6183,   // contact, +- 0.35
  -0.3745,  // texture, +- 1.83
  1.4129,   // color, +- 2.51
  9.2534,   // edges, +- 3.67
  0.0613,   // features, +- 0.66
};
}  // namespace object_modelling::alignment
