#include "symmetry_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "object_modelling/geometry/oriented_box.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr double SIMILAR_MOMENTS = 0.1;   // relative difference that leaves the axes between two open
constexpr int FAN_STEPS = 12;             // over half a turn
constexpr int BALL_DIRECTIONS = 120;      // over the sphere
constexpr double MAX_START_RATIO = 0.06;  // of the diameter: rms of an axis 10 deg off
constexpr double SAME_AXIS_DEG = 5;
/// Both ways round, in no simple relation to each other.
constexpr std::array<double, 7> ANY_ANGLES_DEG{ 17, -29, 53, -73, 101, -137, 180 };

double rad(double deg)
{
  return deg * M_PI / 180;
}

bool similar(double a, double b)
{
  return std::abs(a - b) <= SIMILAR_MOMENTS * std::max(a, b);
}

/// The diagonals of the axes' planes and of their octants.
void addDiagonals(const Eigen::Matrix3d& axes, std::vector<Eigen::Vector3d>* directions)
{
  for (const double y : { -1.0, 0.0, 1.0 })
    for (const double z : { -1.0, 0.0, 1.0 })
    {
      if (y != 0 || z != 0)
        directions->push_back(axes * Eigen::Vector3d(1, y, z).normalized());
      if (y == 1 && z != 0)
        directions->push_back(axes * Eigen::Vector3d(0, y, z).normalized());
    }
}

void addBall(std::vector<Eigen::Vector3d>* directions)
{
  for (int i = 0; i < BALL_DIRECTIONS / 2; ++i)  // the upper half of a Fibonacci spiral
  {
    const double z = 1 - (2 * i + 1.0) / BALL_DIRECTIONS, turn = i * M_PI * (3 - std::sqrt(5.0)),
                 r = std::sqrt(1 - z * z);
    directions->emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
}

bool divides(int divisor, int order)
{
  return divisor < order && order % divisor == 0;
}
}  // namespace

double angleBetween_deg(const Axis& a, const Axis& b)
{
  return std::acos(std::min(1.0, std::abs(a.direction.dot(b.direction)))) * 180 / M_PI;
}

std::vector<Axis> candidateAxes(const SelfComparison& self, const std::vector<Eigen::Vector3f>& vertices)
{
  std::vector<Eigen::Vector3d> directions;
  const Eigen::Matrix3d box = geometry::smallestBox(vertices).T_frame_box.linear();
  for (int i = 0; i < 3; ++i)
    directions.emplace_back(self.momentAxes().col(i));
  for (int i = 0; i < 3; ++i)
    directions.emplace_back(box.col(i));
  const Eigen::Vector3d moments = self.moments_m2();
  const bool low = similar(moments[0], moments[1]), high = similar(moments[1], moments[2]);
  if (low && high)
  {
    addDiagonals(box, &directions);
    addBall(&directions);
  }
  else if (low || high)
  {
    const Eigen::Vector3d u = self.momentAxes().col(low ? 0 : 2), v = self.momentAxes().col(1);
    for (int i = 0; i < FAN_STEPS; ++i)
      directions.push_back(std::cos(M_PI * i / FAN_STEPS) * u + std::sin(M_PI * i / FAN_STEPS) * v);
  }
  std::vector<Axis> axes;
  for (const Eigen::Vector3d& direction : directions)
    axes.push_back({ direction, self.centroid() });
  return axes;
}

SymmetrySearch::SymmetrySearch(const SelfComparison& self, const SymmetryOptions& options)
    : self_(self),
      options_(options),
      tolerance_m_(std::max(options.min_tolerance_m, options.tolerance_ratio * self.diameter_m()))
{
}

bool SymmetrySearch::known(const Axis& axis, int order) const
{
  return std::any_of(findings_.begin(), findings_.end(),
                     [&](const AxisFinding& finding)
                     {
                       return std::any_of(
                           finding.turns.begin(), finding.turns.end(),
                           [&](const AxisFinding::Turn& turn)
                           { return turn.order == order && angleBetween_deg(turn.axis, axis) < SAME_AXIS_DEG; });
                     });
}

bool SymmetrySearch::needless(const Axis& axis) const
{
  int round = 0;
  bool across_round = false, across_known = false;
  for (const AxisFinding& finding : findings_)
    if (finding.turns.back().order == 0)
    {
      ++round;
      across_round |= angleBetween_deg(finding.turns.back().axis, axis) > ACROSS_DEG;
      for (const AxisFinding& other : findings_)
        across_known |= angleBetween_deg(finding.turns.back().axis, other.turns.front().axis) > ACROSS_DEG;
    }
  // All axes across a round one are alike but for the texture.
  return round > 1 || (across_round && across_known && !self_.hasColors());
}

bool SymmetrySearch::holds(const Axis& axis, double angle_rad, double* error_m) const
{
  const Eigen::Isometry3d T = axis.turn(angle_rad);
  if (self_.roughDistance(T).rms_m > 2 * tolerance_m_)
    return false;
  SelfDistance distance = self_.distance(T);
  *error_m = std::max(*error_m, distance.rms_m);
  return distance.rms_m <= tolerance_m_ && distance.quantile_95_m <= options_.max_quantile_ratio * tolerance_m_ &&
         distance.counted_ratio >= options_.min_counted_ratio;
}

bool SymmetrySearch::sameTexture(const Axis& axis, double angle_rad) const
{
  return self_.hasColors() && self_.colorDifference(axis.turn(angle_rad)) <= options_.max_color_difference;
}

bool SymmetrySearch::holdsByAnyAngle(const Axis& axis, double* error_m, bool* of_texture) const
{
  *of_texture = true;
  for (const double angle_deg : ANY_ANGLES_DEG)
  {
    if (!holds(axis, rad(angle_deg), error_m))
      return false;
    *of_texture = *of_texture && sameTexture(axis, rad(angle_deg));
  }
  return true;
}

void SymmetrySearch::tryAxis(const Axis& axis)
{
  if (needless(axis))
    return;
  AxisFinding finding;
  Axis best = axis;
  double least_m = std::numeric_limits<double>::infinity();
  std::vector<bool> held(static_cast<std::size_t>(options_.max_order) + 1, false);
  for (int order = 2; order <= options_.max_order; ++order)
  {
    bool possible = true;
    for (int divisor = 2; divisor < order; ++divisor)
      possible = possible && (!divides(divisor, order) || held[static_cast<std::size_t>(divisor)]);
    const double angle_rad = 2 * M_PI / order;
    if (!possible || self_.roughDistance(best.turn(angle_rad)).rms_m > MAX_START_RATIO * self_.diameter_m())
      continue;
    const Axis refined = self_.refined(best, angle_rad);
    if (known(refined, order))
      return;
    double error_m = 0;
    // The other way round asks how far the surface is from the turned one.
    const bool both = holds(refined, angle_rad, &error_m) && (order == 2 || holds(refined, -angle_rad, &error_m));
    if (!both)
      continue;
    held[static_cast<std::size_t>(order)] = true;
    finding.turns.push_back({ order, refined, error_m, sameTexture(refined, angle_rad) });
    if (error_m < least_m)
      best = refined;
    least_m = std::min(least_m, error_m);
  }
  AxisFinding::Turn any{ 0, best, 0, false };
  if (!finding.turns.empty() && holdsByAnyAngle(best, &any.error_m, &any.of_texture))
    finding.turns.push_back(any);
  if (!finding.turns.empty())
    findings_.push_back(finding);
}

}  // namespace object_modelling::object_properties
