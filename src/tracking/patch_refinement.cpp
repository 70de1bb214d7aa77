#include "patch_refinement.h"

#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace object_modelling::tracking
{
namespace
{
constexpr int HALF = 7;
constexpr int SIDE = 2 * HALF + 1;
constexpr int AREA = SIDE * SIDE;
constexpr int BORDERED = SIDE + 2;

/// Warped reference patch with its gradient.
struct Template
{
  std::array<float, AREA> value;
  std::array<float, AREA> gradient_x;
  std::array<float, AREA> gradient_y;
};

/// Bilinear value; false outside the image.
bool sample(const cv::Mat& image, double u, double v, float* value)
{
  const int iu = static_cast<int>(std::floor(u));
  const int iv = static_cast<int>(std::floor(v));
  if (!(iu >= 0 && iv >= 0 && iu + 1 < image.cols && iv + 1 < image.rows))
    return false;
  const auto a = static_cast<float>(u - iu);
  const auto b = static_cast<float>(v - iv);
  const std::uint8_t* upper = image.ptr<std::uint8_t>(iv) + iu;
  const std::uint8_t* lower = image.ptr<std::uint8_t>(iv + 1) + iu;
  *value = (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
  return true;
}

/// Patch of the reference as the current camera would see it at `centre` (current pixel at level scale).
bool warpTemplate(const cv::Mat& reference, double reference_scale, double current_scale,
                  const Eigen::Matrix3d& H_reference_current, const Eigen::Vector2d& centre, Template* patch)
{
  std::array<float, BORDERED * BORDERED> bordered;
  for (int y = 0; y < BORDERED; ++y)
    for (int x = 0; x < BORDERED; ++x)
    {
      // cv::pyrDown puts pixel u of a level on pixel 2 u of the level below.
      const Eigen::Vector3d at((centre.x() + x - HALF - 1) * current_scale, (centre.y() + y - HALF - 1) * current_scale,
                               1);
      const Eigen::Vector3d mapped = H_reference_current * at;
      if (!(mapped.z() > 1e-9))
        return false;
      const double u = mapped.x() / mapped.z() / reference_scale;
      const double v = mapped.y() / mapped.z() / reference_scale;
      if (!sample(reference, u, v, &bordered[y * BORDERED + x]))
        return false;
    }
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
    {
      const float* at = &bordered[(y + 1) * BORDERED + x + 1];
      patch->value[y * SIDE + x] = at[0];
      patch->gradient_x[y * SIDE + x] = 0.5F * (at[1] - at[-1]);
      patch->gradient_y[y * SIDE + x] = 0.5F * (at[BORDERED] - at[-BORDERED]);
    }
  return true;
}

/// Window of an image with a one-pixel border, at a sub-pixel position; false where it leaves the image.
bool sampleWindow(const cv::Mat& image, const Eigen::Vector2d& centre, std::array<float, BORDERED * BORDERED>* window)
{
  const int u = static_cast<int>(std::floor(centre.x())) - HALF - 1;
  const int v = static_cast<int>(std::floor(centre.y())) - HALF - 1;
  if (!(u >= 0 && v >= 0 && u + BORDERED < image.cols && v + BORDERED < image.rows))
    return false;
  const auto a = static_cast<float>(centre.x() - std::floor(centre.x()));
  const auto b = static_cast<float>(centre.y() - std::floor(centre.y()));
  const float w00 = (1 - a) * (1 - b), w10 = a * (1 - b), w01 = (1 - a) * b, w11 = a * b;
  for (int y = 0; y < BORDERED; ++y)
  {
    const std::uint8_t* upper = image.ptr<std::uint8_t>(v + y) + u;
    const std::uint8_t* lower = image.ptr<std::uint8_t>(v + y + 1) + u;
    float* out = window->data() + y * BORDERED;
    for (int x = 0; x < BORDERED; ++x)
      out[x] = w00 * upper[x] + w10 * upper[x + 1] + w01 * lower[x] + w11 * lower[x + 1];
  }
  return true;
}

/// One Gauss-Newton step for shift, gain and bias of I(x + d) = gain T(d) + bias; also the correlation at the start of
/// it.
bool solveStep(const Template& patch, const std::array<float, BORDERED * BORDERED>& window, Eigen::Vector2d* step,
               float* correlation)
{
  float sum_t = 0, sum_i = 0, sum_tt = 0, sum_ii = 0, sum_ti = 0;
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
    {
      const float t = patch.value[y * SIDE + x];
      const float i = window[(y + 1) * BORDERED + x + 1];
      sum_t += t, sum_i += i, sum_tt += t * t, sum_ii += i * i, sum_ti += t * i;
    }
  const float variance_t = sum_tt - sum_t * sum_t / AREA;
  const float variance_i = sum_ii - sum_i * sum_i / AREA;
  const float covariance = sum_ti - sum_t * sum_i / AREA;
  if (!(variance_t > 1 && variance_i > 1))
    return false;
  *correlation = covariance / std::sqrt(variance_t * variance_i);
  // Least-squares gain and bias for the shift as it is; the shift is then solved for with their directions projected
  // out.
  const float gain = covariance / variance_t;
  const float mean_t = sum_t / AREA;
  const float mean_i = sum_i / AREA;
  float gxx = 0, gxy = 0, gyy = 0, rx = 0, ry = 0, gxt = 0, gyt = 0, gx1 = 0, gy1 = 0;
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
    {
      const int at = y * SIDE + x;
      const float* w = &window[(y + 1) * BORDERED + x + 1];
      const float t = patch.value[at] - mean_t;
      const float residual = (w[0] - mean_i) - gain * t;
      const float gx = 0.5F * (gain * patch.gradient_x[at] + 0.5F * (w[1] - w[-1]));
      const float gy = 0.5F * (gain * patch.gradient_y[at] + 0.5F * (w[BORDERED] - w[-BORDERED]));
      gxx += gx * gx, gxy += gx * gy, gyy += gy * gy;
      rx += gx * residual, ry += gy * residual;
      gxt += gx * t, gyt += gy * t, gx1 += gx, gy1 += gy;
    }
  Eigen::Matrix2d A;
  A << gxx - gxt * gxt / variance_t - gx1 * gx1 / AREA, gxy - gxt * gyt / variance_t - gx1 * gy1 / AREA, 0,
      gyy - gyt * gyt / variance_t - gy1 * gy1 / AREA;
  A(1, 0) = A(0, 1);
  const double determinant = A.determinant();
  const double trace = A.trace();
  // An edge (one eigenvalue next to nothing) holds the patch in one direction only.
  if (!(determinant > 0.005 * trace * trace) || gain <= 0)
    return false;
  *step = -A.inverse() * Eigen::Vector2d(rx, ry);
  return true;
}

struct LevelOutcome
{
  bool converged = false;
  Eigen::Vector2d pixel;
  float correlation = 0;
};

LevelOutcome alignAtLevel(const Template& patch, const cv::Mat& image, const Eigen::Vector2d& start,
                          const PatchRefinementOptions& options)
{
  LevelOutcome outcome;
  outcome.pixel = start;
  std::array<float, BORDERED * BORDERED> window;
  bool small_step = false;
  for (int iteration = 0; iteration <= options.max_iterations; ++iteration)
  {
    Eigen::Vector2d step;
    if (!sampleWindow(image, outcome.pixel, &window) || !solveStep(patch, window, &step, &outcome.correlation))
      return outcome;
    if (small_step)
    {
      outcome.converged = true;
      return outcome;
    }
    outcome.pixel += step;
    if ((outcome.pixel - start).norm() > options.max_displacement_px)
      return outcome;
    small_step = step.norm() < options.convergence_px;
  }
  return outcome;
}
}  // namespace

Eigen::Matrix3d patchHomography(const Eigen::Matrix3d& K, const Eigen::Matrix3d& R_current_reference,
                                const Eigen::Vector3d& t_current_reference, const Eigen::Vector3d& n_reference,
                                const Eigen::Vector3d& p_reference)
{
  return K * (R_current_reference + t_current_reference * n_reference.transpose() / n_reference.dot(p_reference)) *
         K.inverse();
}

PatchRefinement refinePatch(const std::vector<cv::Mat>& reference, const std::vector<cv::Mat>& current,
                            const Eigen::Matrix3d& H_current_reference, const Eigen::Vector2f& reference_pixel,
                            const Eigen::Vector2f& start, double start_error_px, const PatchRefinementOptions& options)
{
  PatchRefinement result;
  const Eigen::Vector3d mapped = H_current_reference * reference_pixel.cast<double>().homogeneous();
  if (!(mapped.z() > 1e-9))
    return result;
  const Eigen::Vector2d projected = mapped.hnormalized();
  const Eigen::Matrix3d H_reference_current = H_current_reference.inverse();
  // How many reference pixels one current pixel covers chooses the reference's level, against aliasing.
  const double magnification = std::sqrt(std::abs(H_current_reference.determinant()) / std::pow(mapped.z(), 3));
  if (!std::isfinite(magnification) || magnification < 0.2 || magnification > 5)
    return result;

  Eigen::Vector2d pixel = start.cast<double>();
  const bool coarse = start_error_px > options.coarse_start_px && current.size() > 1;
  for (int level = coarse ? 1 : 0; level >= 0; --level)
  {
    const double scale = 1 << level;
    const int reference_level = std::min(static_cast<int>(reference.size()) - 1,
                                         std::max(0, static_cast<int>(std::lround(std::log2(scale / magnification)))));
    const Eigen::Vector2d centre = projected / scale;
    Template patch;
    if (!warpTemplate(reference[reference_level], 1 << reference_level, scale, H_reference_current, centre, &patch))
      return result;
    const LevelOutcome outcome = alignAtLevel(patch, current[level], pixel / scale, options);
    if (!outcome.converged)
      return result;
    pixel = outcome.pixel * scale;
    result.correlation = outcome.correlation;
  }
  result.pixel = pixel.cast<float>();
  result.accepted = result.correlation >= options.min_correlation;
  return result;
}

}  // namespace object_modelling::tracking
