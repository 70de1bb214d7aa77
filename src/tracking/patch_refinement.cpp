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

using Values =
    Eigen::Matrix<float, AREA, 1>;  // Eigen sums it four at a time, in an order of its own but always the same

/// Warped reference patch, without its mean, with its gradient.
struct Template
{
  Values value, gradient_x, gradient_y;
  float variance = 0;  ///< sum of squares of `value`
};

/// Patch of the reference as the current camera would see it at `centre` (current pixel at level scale); false where it
/// leaves the reference.
bool warpTemplate(const cv::Mat& reference, double reference_scale, double current_scale,
                  const Eigen::Matrix3d& H_reference_current, const Eigen::Vector2d& centre, Template* patch)
{
  // From the window's first pixel at level scale to the reference's level; cv::pyrDown puts pixel u of a level on pixel
  // 2 u of the level below.
  Eigen::Matrix3d H = H_reference_current;
  H.col(2) += current_scale * (H.leftCols<2>() * (centre.array() - (HALF + 1)).matrix());
  H.leftCols<2>() *= current_scale;
  H.topRows<2>() /= reference_scale;
  // A quadrilateral in front of the camera is inside if its corners are.
  for (const double y : { 0, BORDERED - 1 })
    for (const double x : { 0, BORDERED - 1 })
    {
      const Eigen::Vector3d mapped = H * Eigen::Vector3d(x, y, 1);
      if (!(mapped.z() > 1e-9))
        return false;
      const Eigen::Vector2d corner = mapped.hnormalized();
      if (!(corner.x() >= 0.01 && corner.y() >= 0.01 && corner.x() < reference.cols - 1.01 &&
            corner.y() < reference.rows - 1.01))
        return false;
    }
  std::array<float, BORDERED * BORDERED> bordered;
  std::array<float, BORDERED> u, v;
  const Eigen::Matrix3f h = H.cast<float>();
  for (int y = 0; y < BORDERED; ++y)
  {
    const auto fy = static_cast<float>(y);
    const float u0 = h(0, 1) * fy + h(0, 2), v0 = h(1, 1) * fy + h(1, 2), z0 = h(2, 1) * fy + h(2, 2);
    for (int x = 0; x < BORDERED; ++x)
    {
      const auto fx = static_cast<float>(x);
      const float inverse_z = 1 / (h(2, 0) * fx + z0);
      u[x] = (h(0, 0) * fx + u0) * inverse_z;
      v[x] = (h(1, 0) * fx + v0) * inverse_z;
    }
    float* out = &bordered[static_cast<std::size_t>(y) * BORDERED];
    for (int x = 0; x < BORDERED; ++x)
    {
      const int iu = static_cast<int>(u[x]);
      const int iv = static_cast<int>(v[x]);
      const float a = u[x] - static_cast<float>(iu);
      const float b = v[x] - static_cast<float>(iv);
      const std::uint8_t* upper = reference.ptr<std::uint8_t>(iv) + iu;
      const std::uint8_t* lower = upper + reference.step;
      const float top = static_cast<float>(upper[0]) + a * static_cast<float>(upper[1] - upper[0]);
      const float bottom = static_cast<float>(lower[0]) + a * static_cast<float>(lower[1] - lower[0]);
      out[x] = top + b * (bottom - top);
    }
  }
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
    {
      const float* at = &bordered[(y + 1) * BORDERED + x + 1];
      patch->value(y * SIDE + x) = at[0];
      patch->gradient_x(y * SIDE + x) = 0.5F * (at[1] - at[-1]);
      patch->gradient_y(y * SIDE + x) = 0.5F * (at[BORDERED] - at[-BORDERED]);
    }
  patch->value.array() -= patch->value.mean();
  patch->variance = patch->value.squaredNorm();
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
  Values value, gradient_x, gradient_y;
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
    {
      const float* w = &window[(y + 1) * BORDERED + x + 1];
      value(y * SIDE + x) = w[0];
      gradient_x(y * SIDE + x) = 0.5F * (w[1] - w[-1]);
      gradient_y(y * SIDE + x) = 0.5F * (w[BORDERED] - w[-BORDERED]);
    }
  value.array() -= value.mean();
  const float variance_i = value.squaredNorm();
  const float covariance = value.dot(patch.value);
  if (!(patch.variance > 1 && variance_i > 1))
    return false;
  *correlation = covariance / std::sqrt(patch.variance * variance_i);
  // Least-squares gain and bias for the shift as it is; the shift is then solved for with their directions projected
  // out.
  const float gain = covariance / patch.variance;
  value -= gain * patch.value;
  gradient_x = 0.5F * (gain * patch.gradient_x + gradient_x);
  gradient_y = 0.5F * (gain * patch.gradient_y + gradient_y);
  gradient_x.array() -= gradient_x.mean();
  gradient_y.array() -= gradient_y.mean();
  const float gxt = gradient_x.dot(patch.value);
  const float gyt = gradient_y.dot(patch.value);
  const float rx = gradient_x.dot(value);
  const float ry = gradient_y.dot(value);
  Eigen::Matrix2d A;
  A << gradient_x.squaredNorm() - gxt * gxt / patch.variance, gradient_x.dot(gradient_y) - gxt * gyt / patch.variance,
      0, gradient_y.squaredNorm() - gyt * gyt / patch.variance;
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
  for (int iteration = 0; iteration < options.max_iterations && !outcome.converged; ++iteration)
  {
    Eigen::Vector2d step;
    if (!sampleWindow(image, outcome.pixel, &window) || !solveStep(patch, window, &step, &outcome.correlation))
      return outcome;
    outcome.pixel += step;
    if ((outcome.pixel - start).norm() > options.max_displacement_px)
      return outcome;
    // The correlation is that before the last step, which is too small to tell.
    outcome.converged = step.norm() < options.convergence_px;
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
