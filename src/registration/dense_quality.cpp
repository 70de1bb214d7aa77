#include "object_modelling/registration/dense_quality.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::registration
{
namespace
{
struct Bounds
{
  int in_view;
  double depth_agreement;
  double correlation;
  double overlap;
};

constexpr Bounds PLAUSIBLE = { 100, 0.5, 0.4, 0.0 };
constexpr Bounds CONVINCING = { 200, 0.7, 0.6, 0.4 };
constexpr Bounds CERTAIN = { 500, 0.8, 0.8, 0.5 };

bool meets(const DenseTerm& term, const Bounds& bounds)
{
  return term.in_view >= bounds.in_view && term.depth_agreement >= bounds.depth_agreement &&
         term.correlation >= bounds.correlation && term.overlap >= bounds.overlap;
}

std::string percent(double share)
{
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}
}  // namespace

double quality(const DenseTerm& term)
{
  return std::max(0.0, term.correlation) * term.depth_agreement * std::min(1.0, 2 * term.overlap);
}

bool plausible(const DenseTerm& term)
{
  return meets(term, PLAUSIBLE);
}

bool convincing(const DenseTerm& term)
{
  return meets(term, CONVINCING);
}

bool certain(const DenseTerm& term)
{
  return meets(term, CERTAIN);
}

std::string describe(const DenseTerm& term)
{
  return percent(term.overlap) + " in view, depth of " + percent(term.depth_agreement) + " agrees, brightness by " +
         percent(term.correlation);
}

}  // namespace object_modelling::registration
