#include "icp_equations.h"

#include <cmath>

#include "object_modelling/geometry/image_sampling.h"

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr double GRADIENT_NOISE = 1;          // grey levels per pixel
constexpr double GRADIENT_NOISE_RATIO = 0.1;  // of a gradient: staircases of edges, interpolation
constexpr double NORMAL_NOISE_PX = 3;         // a normal is as unsure as depth is, over this many pixels

/// [direction; q x direction], the derivative by a motion of what is measured along `direction` at q.
geometry::Vector6d derivative(const Eigen::Vector3d& q, const Eigen::Vector3d& direction)
{
  geometry::Vector6d jacobian;
  jacobian << direction, q.cross(direction);
  return jacobian;
}

double robustWeight(double residual_sigmas, double width)
{
  const double ratio = residual_sigmas / width;
  return 1 / (1 + ratio * ratio);
}

double robustCost(double residual_sigmas, double width)
{
  const double ratio = residual_sigmas / width;
  return 0.5 * width * width * std::log1p(ratio * ratio);
}

/// Calls visit(q, direction, residual_sigmas) for each point-to-plane residual.
template <typename Visit>
void forSurface(const IcpMatches& matches, const Eigen::Isometry3d& T_a_b, Visit visit)
{
  for (const SurfaceMatch& match : matches.surface)
  {
    const Eigen::Vector3d q = T_a_b * match.p_b.cast<double>();
    const Eigen::Vector3d n = match.n_a.cast<double>();
    visit(q, n, n.dot(q - match.p_a.cast<double>()) / match.sigma_m, match);
  }
}

/// Derivative by the point of what an image shows there.
Eigen::Vector3d imageDirection(const IcpImage& image, const Eigen::Vector3d& q, double gradient_x, double gradient_y)
{
  const double x = gradient_x * image.fx / q.z();
  const double y = gradient_y * image.fy / q.z();
  return { x, y, -(x * q.x() + y * q.y()) / q.z() };
}

/// Calls visit(q, gradient, residual_sigmas) for each grey level that can be compared.
template <typename Visit>
void forColor(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b, const IcpLoss& loss,
              Visit visit)
{
  if (matches.color.empty() || !(loss.color_weight > 0))
    return;
  const IcpImage& image = a.images()[loss.color_level];
  for (const ColorMatch& match : matches.color)
  {
    const Eigen::Vector3d q = T_a_b * match.p_b.cast<double>();
    float value;
    Eigen::Vector2f gradient;
    if (geometry::sampleGray(image.gray, static_cast<float>(image.fx * q.x() / q.z() + image.cx),
                             static_cast<float>(image.fy * q.y() / q.z() + image.cy), &value, &gradient))
      visit(q, gradient, (value - match.intensity) / matches.color_sigma);
  }
}
}  // namespace

double icpCost(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b, const IcpLoss& loss)
{
  double surface = 0, color = 0;
  forSurface(matches, T_a_b,
             [&](const Eigen::Vector3d&, const Eigen::Vector3d&, double residual, const SurfaceMatch&)
             { surface += robustCost(residual, loss.width_sigmas); });
  forColor(a, matches, T_a_b, loss,
           [&](const Eigen::Vector3d&, const Eigen::Vector2f&, double residual)
           { color += robustCost(residual, loss.width_sigmas); });
  return surface + loss.color_weight * color;
}

IcpEquations icpEquations(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b,
                          const IcpLoss& loss)
{
  IcpEquations equations;
  const auto add = [&](const geometry::Vector6d& jacobian, double residual, double importance)
  {
    const double weight = importance * robustWeight(residual, loss.width_sigmas);
    equations.cost += importance * robustCost(residual, loss.width_sigmas);
    equations.A.noalias() += weight * jacobian * jacobian.transpose();
    equations.g += weight * residual * jacobian;
  };
  forSurface(matches, T_a_b,
             [&](const Eigen::Vector3d& q, const Eigen::Vector3d& n, double residual, const SurfaceMatch& match)
             { add(derivative(q, n) / match.sigma_m, residual, 1); });
  forColor(a, matches, T_a_b, loss,
           [&](const Eigen::Vector3d& q, const Eigen::Vector2f& gradient, double residual)
           {
             const IcpImage& image = a.images()[loss.color_level];
             add(derivative(q, imageDirection(image, q, gradient.x(), gradient.y())) / matches.color_sigma, residual,
                 loss.color_weight);
           });
  return equations;
}

geometry::Matrix6d icpNoise(const IcpView& a, const IcpMatches& matches, const Eigen::Isometry3d& T_a_b,
                            const IcpLoss& loss)
{
  geometry::Matrix6d noise = geometry::Matrix6d::Zero();
  const auto add = [&](const geometry::Vector6d& jacobian, double weight)
  { noise.noalias() += weight * jacobian * jacobian.transpose(); };
  forSurface(matches, T_a_b,
             [&](const Eigen::Vector3d& q, const Eigen::Vector3d& n, double residual, const SurfaceMatch& match)
             {
               const double slope = match.noise_m * a.focal_px() / (NORMAL_NOISE_PX * q.z());
               const double weight =
                   robustWeight(residual, loss.width_sigmas) * slope * slope / (match.sigma_m * match.sigma_m);
               const Eigen::Vector3d tangent = n.unitOrthogonal();
               add(derivative(q, tangent), weight);
               add(derivative(q, n.cross(tangent)), weight);
             });
  forColor(a, matches, T_a_b, loss,
           [&](const Eigen::Vector3d& q, const Eigen::Vector2f& gradient, double residual)
           {
             const IcpImage& image = a.images()[loss.color_level];
             const double weight = loss.color_weight * robustWeight(residual, loss.width_sigmas) *
                                   (GRADIENT_NOISE * GRADIENT_NOISE + GRADIENT_NOISE_RATIO * GRADIENT_NOISE_RATIO *
                                                                          static_cast<double>(gradient.squaredNorm())) /
                                   (matches.color_sigma * matches.color_sigma);
             add(derivative(q, imageDirection(image, q, 1, 0)), weight);
             add(derivative(q, imageDirection(image, q, 0, 1)), weight);
           });
  return noise;
}

double IcpError::rmse_m() const
{
  return weight > 0 ? std::sqrt(squared_m2 / weight) : 0;
}

void IcpError::add(const IcpError& other)
{
  squared_m2 += other.squared_m2;
  weight += other.weight;
  squared_sigmas += other.squared_sigmas;
  count += other.count;
}

IcpError icpError(const IcpMatches& matches, const Eigen::Isometry3d& T_a_b, const Eigen::Isometry3d& T_a_b_weights,
                  const IcpLoss& loss)
{
  IcpError error;
  for (const SurfaceMatch& match : matches.surface)
  {
    const auto distance_m = [&](const Eigen::Isometry3d& T)
    { return match.n_a.cast<double>().dot(T * match.p_b.cast<double>() - match.p_a.cast<double>()); };
    const double weight = robustWeight(distance_m(T_a_b_weights) / match.sigma_m, loss.width_sigmas);
    const double squared_m2 = weight * std::pow(distance_m(T_a_b), 2);
    error.squared_m2 += squared_m2;
    error.squared_sigmas += squared_m2 / (match.sigma_m * match.sigma_m);
    error.weight += weight;
  }
  error.count = static_cast<int>(matches.surface.size());
  return error;
}

}  // namespace object_modelling::multi_view_icp
