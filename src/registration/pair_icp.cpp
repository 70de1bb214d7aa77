#include "object_modelling/registration/pair_icp.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/registration/support_contact.h"

namespace object_modelling::registration
{
namespace
{
constexpr float MIN_MATCH_COSINE = 0.5F;
constexpr float FREE_DIRECTION_WEIGHT = 1e-5F;  // of the mean information: what nothing constrains stays
constexpr float CONTACT_WEIGHT =
    0.01F;  // of the mean information: the other's support plane constrains what surfaces do not
constexpr float MAX_CONTACT_RATIO = 0.12F;  // of the part's radius; what is farther off does not stand there
constexpr float MIN_COLOR_SIGMA = 0.08F;    // of what texture differs by between sessions: light, focus
constexpr float SURFACE_SIGMA_M = 0.0003F;  // of fused points; colours decide only what shape leaves open
constexpr float MIN_SCALE_M = 0.001F;
constexpr int MIN_PAIRS = 20;

/// Normal equations of a motion about a centre, rotation counted by the arc at the radius.
struct Equations
{
  Eigen::Matrix<float, 6, 6> A = Eigen::Matrix<float, 6, 6>::Zero();
  Eigen::Matrix<float, 6, 1> b = Eigen::Matrix<float, 6, 1>::Zero();
  int pairs = 0;
  double color_squares = 0;

  void add(const Eigen::Vector3f& arm, const Eigen::Vector3f& direction, float residual, float weight)
  {
    Eigen::Matrix<float, 6, 1> J;
    J << direction, arm.cross(direction);
    A += weight * J * J.transpose();
    b -= weight * residual * J;
  }
};

float robustWeight(float residual, float scale)
{
  const float ratio = residual / scale;
  return 1 / (1 + ratio * ratio);
}

/// Adds the pairs of `moving` found on `fixed`. `sign` -1: the motion sought moves `fixed` instead; then the residual
/// is seen from there, in its frame.
void addPairs(const MatchedSurface& fixed, const MatchedSurface& moving, const Eigen::Isometry3f& T_fixed_moving,
              const Eigen::Isometry3f& T_a_fixed, float sign, const MatchedSurface& a, float gate_m, float color_sigma,
              const PairIcpOptions& options, Equations* equations)
{
  const SurfaceField& field = options.coarse ? fixed.coarse : fixed.fine;
  const bool blurred = options.color == ColorDetail::BLURRED;
  const std::vector<Eigen::Vector3f>& fixed_colors = blurred ? fixed.blurred_colors : fixed.colors;
  const std::vector<Eigen::Vector3f>& moving_colors = blurred ? moving.blurred_colors : moving.colors;
  const std::vector<ColorGradient>& gradients = blurred ? fixed.blurred_gradients : fixed.gradients;
  const Eigen::Matrix3f R = T_fixed_moving.linear();
  for (const int i : options.coarse ? moving.coarse_samples : moving.fine_samples)
  {
    const Eigen::Vector3f q = T_fixed_moving * moving.model.points[i];
    const int j = field.nearest(q);
    if (j < 0)
      continue;
    const Eigen::Vector3f& n = fixed.model.normals[j];
    if (n.dot(R * moving.model.normals[i]) < MIN_MATCH_COSINE)
      continue;
    const Eigen::Vector3f off = q - fixed.model.points[j];
    const float residual = n.dot(off);
    if (std::abs(residual) > gate_m)
      continue;
    ++equations->pairs;
    const Eigen::Vector3f arm = (T_a_fixed * q - a.center) / a.radius_m;
    const float scale = std::max(MIN_SCALE_M, gate_m / 3);
    equations->add(arm, T_a_fixed.linear() * n * sign, residual,
                   robustWeight(residual, scale) / (SURFACE_SIGMA_M * SURFACE_SIGMA_M));
    if (options.color == ColorDetail::NONE)
      continue;
    const Eigen::Vector3f along = off - n * residual;
    const Eigen::Vector3f difference = fixed_colors[j] + gradients[j] * along - moving_colors[i];
    equations->color_squares += difference.squaredNorm() / 3;
    for (int channel = 0; channel < 3; ++channel)
    {
      const Eigen::Vector3f slope = gradients[j].row(channel);
      equations->add(arm, T_a_fixed.linear() * slope * sign, difference[channel],
                     robustWeight(difference[channel], 2 * color_sigma) / (color_sigma * color_sigma));
    }
  }
}

/// Each part stands on the other's support plane: a can that was turned over is held along its axis by nothing else.
void addContact(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b, Equations* equations)
{
  const float weight = CONTACT_WEIGHT * equations->A.trace() / 6, max_gap_m = MAX_CONTACT_RATIO * a.radius_m;
  const auto add = [&](const Eigen::Vector3f& p_a, const Eigen::Vector3f& direction, float height_m)
  {
    if (std::abs(height_m) < max_gap_m)
      equations->add((p_a - a.center) / a.radius_m, direction, height_m, weight);
  };
  if (a.model.support_plane)
  {
    const LowestPoint lowest = lowestPoint(b, T_a_b, *a.model.support_plane);
    add(T_a_b * lowest.point, a.model.support_plane->normal.cast<float>(), lowest.height_m);
  }
  if (b.model.support_plane)
  {
    const LowestPoint lowest = lowestPoint(a, T_a_b.inverse(), *b.model.support_plane);
    add(lowest.point, -(T_a_b.linear() * b.model.support_plane->normal.cast<float>()), lowest.height_m);
  }
}
}  // namespace

Eigen::Isometry3f alignByIcp(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b,
                             const PairIcpOptions& options)
{
  Eigen::Isometry3f T = T_a_b;
  auto gate_m = static_cast<float>(options.gate_m);
  float color_sigma = 3 * MIN_COLOR_SIGMA;  // then what the colours are found to differ by
  for (int iteration = 0; iteration < options.iterations; ++iteration)
  {
    Equations equations;
    addPairs(a, b, T, Eigen::Isometry3f::Identity(), 1, a, gate_m, color_sigma, options, &equations);
    if (!options.coarse)
      addPairs(b, a, T.inverse(), T, -1, a, gate_m, color_sigma, options, &equations);
    if (equations.pairs < MIN_PAIRS)
      return T;
    color_sigma = std::max(MIN_COLOR_SIGMA, static_cast<float>(std::sqrt(equations.color_squares / equations.pairs)));
    if (!options.coarse)
      addContact(a, b, T, &equations);
    equations.A.diagonal().array() += FREE_DIRECTION_WEIGHT * equations.A.trace() / 6;
    const geometry::Vector6f step = geometry::solveSymmetric(equations.A, equations.b);
    if (!step.allFinite())
      return T;
    // About the centre, the arc over the radius.
    const Eigen::Vector3f turn = step.tail<3>() / a.radius_m;
    Eigen::Isometry3f motion = Eigen::Isometry3f::Identity();
    if (turn.norm() > 1e-9F)
      motion.linear() = Eigen::AngleAxisf(turn.norm(), turn.normalized()).toRotationMatrix();
    motion.translation() = a.center - motion.linear() * a.center + step.head<3>();
    T = motion * T;
    gate_m = std::max(static_cast<float>(options.last_gate_m), gate_m * 0.7F);
    if (step.norm() < 1e-5F)
      break;
  }
  T.linear() = Eigen::Quaternionf(T.linear()).normalized().toRotationMatrix();
  return T;
}

}  // namespace object_modelling::registration
