#include "object_modelling/registration/invariant_colors.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/geometry/point_index.h"

namespace object_modelling::registration
{
namespace
{
constexpr double SURROUNDINGS_M = 0.02;  // over which brightness is compared: light changes more slowly
constexpr float LIT_ALIKE_COSINE = 0.8F;
constexpr float DARK_LEVEL = 12, HUE_DARK_LEVEL = 20;  // grey levels below which brightness and hue are noise
constexpr float MAX_CONTRAST = 1.2F;                   // of logarithms
constexpr float HALF_HUE = 0.15F;                      // length of opponent colours that is compressed to one half

constexpr std::size_t MIN_VALUES = 30;
constexpr double DAMPING = 0.02;      // of the harmonics but the constant: one face must not explain its own texture
constexpr double MIN_SCATTER = 0.03;  // of logarithms of brightness, robust deviation
constexpr int REWEIGHTINGS = 6;

using Harmonics = Eigen::Matrix<double, 9, 1>;

Harmonics harmonicsOf(const Eigen::Vector3f& normal)
{
  const double x = normal.x(), y = normal.y(), z = normal.z();
  Harmonics result;
  result << 1, x, y, z, x * y, y * z, x * z, x * x - y * y, 3 * z * z - 1;
  return result;
}

Eigen::Vector2f opponentColors(const Eigen::Vector3f& rgb)
{
  const float sum = rgb.sum() + 3 * HUE_DARK_LEVEL;
  const Eigen::Vector2f hue(1.5F * (rgb.x() - rgb.y()) / sum, 0.87F * (rgb.x() + rgb.y() - 2 * rgb.z()) / sum);
  return hue / (hue.norm() + HALF_HUE);
}
}  // namespace

std::vector<float> shadingOf(const std::vector<float>& values, const std::vector<Eigen::Vector3f>& normals)
{
  std::vector<float> shading(values.size(), 0);
  if (values.size() < MIN_VALUES)
    return shading;
  std::vector<double> weights(values.size(), 1), left(values.size());
  Eigen::Matrix<double, 9, 9> damping = Eigen::Matrix<double, 9, 9>::Identity();
  damping *= DAMPING * static_cast<double>(values.size());
  damping(0, 0) = 1e-6;
  Harmonics light = Harmonics::Zero();
  for (int round = 0; round < REWEIGHTINGS; ++round)
  {
    Eigen::Matrix<double, 9, 9> A = damping;
    Harmonics b = Harmonics::Zero();
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const Harmonics x = harmonicsOf(normals[i]);
      A += weights[i] * x * x.transpose();
      b += weights[i] * values[i] * x;
    }
    light = geometry::solveSymmetric(A, b);
    for (std::size_t i = 0; i < values.size(); ++i)
      left[i] = values[i] - light.dot(harmonicsOf(normals[i]));
    const double scatter = std::max(MIN_SCATTER, base::robustDeviation(left));
    for (std::size_t i = 0; i < values.size(); ++i)
      weights[i] = std::pow(1 + std::pow(left[i] / (2 * scatter), 2), -2);
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    shading[i] = static_cast<float>(values[i] - left[i]);
  return shading;
}

std::vector<Eigen::Vector3f> invariantColors(const std::vector<Eigen::Vector3f>& points,
                                             const std::vector<Eigen::Vector3f>& normals,
                                             const std::vector<Rgb>& colors_rgb)
{
  std::vector<float> brightness;
  for (const Rgb& rgb : colors_rgb)
    brightness.push_back(std::log(rgb.cast<float>().sum() + 3 * DARK_LEVEL));
  const std::vector<float> shading = shadingOf(brightness, normals);
  for (std::size_t i = 0; i < brightness.size(); ++i)
    brightness[i] -= shading[i];

  const geometry::PointIndex tree(points);
  std::vector<Eigen::Vector3f> colors(points.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < static_cast<int>(points.size()); ++i)
  {
    float sum = 0, count = 0;
    for (const std::uint32_t near : tree.within(points[i], SURROUNDINGS_M))
      if (normals[near].dot(normals[i]) > LIT_ALIKE_COSINE)
      {
        sum += brightness[near];
        count += 1;
      }
    const float contrast = count > 0 ? brightness[i] - sum / count : 0;
    colors[i] << std::clamp(contrast, -MAX_CONTRAST, MAX_CONTRAST), opponentColors(colors_rgb[i].cast<float>());
  }
  return colors;
}

}  // namespace object_modelling::registration
