#pragma once

// Written by test/benchmark/evidence/alignment_evidence.py fit_difference; docs/alignment.md. Not to be edited by hand.
// Fitted on 657 rivals of right poses.
namespace object_modelling::alignment
{
constexpr double DIFFERENCE_BIAS = -6.8912;  // +- 5.13
constexpr double DIFFERENCE_WEIGHTS[] = {
  -1.1703,  // stray, +- 0.90
  -0.8325,  // texture, +- 0.66
  -0.2087,  // rivalry, +- 0.38
};
}  // namespace object_modelling::alignment
