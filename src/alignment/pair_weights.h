#pragma once

// Written by test/benchmark/evidence/alignment_evidence.py fit; docs/alignment.md. Not to be edited by hand.
// Fitted on 144 pairs, calibrated on 85.
namespace object_modelling::alignment
{
constexpr double WEIGHT_BIAS = 4.0133;  // +- 2.85
constexpr double WEIGHTS[] = {
  8.7386,   // overlap, +- 23.64
  0.9907,   // space, +- 0.94
  4.6304,   // through, +- 1.85
  2.7160,   // fit, +- 2.36
  0.9291,   // contact, +- 0.48
  -3.0938,  // print, +- 3.42
  4.6057,   // color, +- 5.19
  11.0864,  // edges, +- 7.61
  0.0000,   // features, +- 1.18
};
}  // namespace object_modelling::alignment
