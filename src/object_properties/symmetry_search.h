#pragma once

#include <vector>

#include "object_modelling/object_properties/symmetry.h"
#include "self_comparison.h"

namespace object_modelling::object_properties
{
/// One axis with the orders of the turns about it that hold (0: by any angle).
struct AxisFinding
{
  struct Turn
  {
    int order = 0;
    Axis axis;  ///< refined for this order
    double error_m = 0;
    bool of_texture = false;  ///< of the shape it is anyway
  };
  std::vector<Turn> turns;  ///< ascending orders; that of any angle last
};

/// Directions through the centroid that may be axes, the likely ones first.
std::vector<Axis> candidateAxes(const SelfComparison& self, const std::vector<Eigen::Vector3f>& vertices);

/// Tries candidates one after the other.
class SymmetrySearch
{
public:
  SymmetrySearch(const SelfComparison& self, const SymmetryOptions& options);
  void tryAxis(const Axis& axis);
  const std::vector<AxisFinding>& findings() const { return findings_; }

private:
  bool known(const Axis& axis, int order) const;
  bool needless(const Axis& axis) const;  ///< what was found implies all that could be found there
  bool holds(const Axis& axis, double angle_rad, double* error_m) const;
  bool holdsByAnyAngle(const Axis& axis, double* error_m, bool* of_texture) const;
  bool sameTexture(const Axis& axis, double angle_rad) const;

  const SelfComparison& self_;
  SymmetryOptions options_;
  double tolerance_m_;
  std::vector<AxisFinding> findings_;
};

/// Axes at a larger angle are across each other.
constexpr double ACROSS_DEG = 80;
/// Degrees between the axes' lines, in [0, 90].
double angleBetween_deg(const Axis& a, const Axis& b);

}  // namespace object_modelling::object_properties
