#include "object_modelling/object_properties/symmetry.h"

#include <algorithm>

#include "object_modelling/base/options.h"
#include "symmetry_search.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr double PARALLEL_DEG = 10;

using Turn = AxisFinding::Turn;

Symmetry symmetryOf(const Turn& turn, Symmetry::Of of)
{
  return { of, turn.axis.direction, turn.axis.point_m, turn.order, turn.error_m };
}

/// The one most across `axis`, of those across it; with `order` where that is given (not negative).
const Turn* mostAcross(const std::vector<std::vector<Turn>>& axes, const Axis& axis, int order)
{
  const Turn* best = nullptr;
  for (const std::vector<Turn>& turns : axes)
    for (const Turn& turn : turns)
      if (turn.order == order && angleBetween_deg(turn.axis, axis) > ACROSS_DEG &&
          (best == nullptr || turn.error_m < best->error_m))
        best = &turn;
  return best;
}

const Turn* roundApartFrom(const std::vector<std::vector<Turn>>& axes, const Axis& axis)
{
  const Turn* best = nullptr;
  for (const std::vector<Turn>& turns : axes)
  {
    const double angle_deg = angleBetween_deg(turns.back().axis, axis);
    if (turns.back().order == 0 && angle_deg > PARALLEL_DEG &&
        (best == nullptr || angle_deg > angleBetween_deg(best->axis, axis)))
      best = &turns.back();
  }
  return best;
}

/// Of an object that is round about `round`: what generates all its symmetries.
std::vector<Symmetry> ofRound(const Turn& round, const std::vector<std::vector<Turn>>& axes, Symmetry::Of of)
{
  std::vector<Symmetry> symmetries{ symmetryOf(round, of) };
  const Turn* second = roundApartFrom(axes, round.axis);
  if (second == nullptr)
    second = mostAcross(axes, round.axis, 2);
  if (second != nullptr)
    symmetries.push_back(symmetryOf(*second, of));
  return symmetries;
}

std::vector<Symmetry> reduced(const std::vector<std::vector<Turn>>& axes, Symmetry::Of of)
{
  std::vector<Symmetry> symmetries;
  for (const std::vector<Turn>& turns : axes)
  {
    if (turns.back().order == 0)
      return ofRound(turns.back(), axes, of);
    for (const Turn& turn : turns)
    {
      const bool implied =
          std::any_of(turns.begin(), turns.end(),
                      [&](const Turn& other) { return other.order > turn.order && other.order % turn.order == 0; });
      if (!implied)
        symmetries.push_back(symmetryOf(turn, of));
    }
  }
  std::stable_sort(symmetries.begin(), symmetries.end(),
                   [](const Symmetry& a, const Symmetry& b) { return a.order > b.order; });
  return symmetries;
}

std::vector<std::vector<Turn>> turnsOf(const std::vector<AxisFinding>& findings, Symmetry::Of of)
{
  std::vector<std::vector<Turn>> axes;
  for (const AxisFinding& finding : findings)
  {
    std::vector<Turn> turns;
    for (const Turn& turn : finding.turns)
      if (of == Symmetry::Of::SHAPE || turn.of_texture)
        turns.push_back(turn);
    if (!turns.empty())
      axes.push_back(std::move(turns));
  }
  return axes;
}
}  // namespace

std::vector<std::string> SymmetryOptions::violations() const
{
  base::OptionsCheck check("symmetry");
  check.atLeast("min_tolerance_m", min_tolerance_m, 0.0);
  check.inRange("tolerance_ratio", tolerance_ratio, 0.0, 0.1);
  check.atLeast("max_quantile_ratio", max_quantile_ratio, 1.0);
  check.inRange("max_color_difference", max_color_difference, 0.0, 255.0);
  check.inRange("min_counted_ratio", min_counted_ratio, 0.0, 1.0);
  check.inRange("max_order", max_order, 2, 12);
  return check.violations();
}

std::vector<Symmetry> findSymmetries(const mesh::TriangleMesh& mesh, const SymmetryOptions& options)
{
  base::checked(options);
  if (!(mesh::surfaceArea_m2(mesh) > 0))
    return {};
  const SelfComparison self(mesh);
  SymmetrySearch search(self, options);
  for (const Axis& axis : candidateAxes(self, mesh.vertices))
    search.tryAxis(axis);
  std::vector<Symmetry> symmetries = reduced(turnsOf(search.findings(), Symmetry::Of::SHAPE), Symmetry::Of::SHAPE);
  const std::vector<Symmetry> of_texture =
      reduced(turnsOf(search.findings(), Symmetry::Of::TEXTURE), Symmetry::Of::TEXTURE);
  symmetries.insert(symmetries.end(), of_texture.begin(), of_texture.end());
  return symmetries;
}

}  // namespace object_modelling::object_properties
