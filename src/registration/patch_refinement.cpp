#include "object_modelling/registration/patch_refinement.h"

#include <cmath>

#include <Eigen/Dense>

#include "patch_kernels.h"

namespace object_modelling::registration
{
namespace
{
/// Patch of the reference as the current camera would see it at `centre` (current pixel at level scale); false where it
/// leaves the reference.
bool warpTemplate(const cv::Mat& reference, double reference_scale, double current_scale,
                  const Eigen::Matrix3d& H_reference_current, const Eigen::Vector2d& center, PatchTemplate* patch)
{
  // From the window's first pixel at level scale to the reference's level; cv::pyrDown puts pixel u of a level on pixel
  // 2 u of the level below.
  Eigen::Matrix3d H = H_reference_current;
  H.col(2) += current_scale * (H.leftCols<2>() * (center.array() - (PATCH_HALF + 1)).matrix());
  H.leftCols<2>() *= current_scale;
  H.topRows<2>() /= reference_scale;
  // A quadrilateral in front of the camera is inside if its corners are.
  for (const double y : { 0, WINDOW_SIDE - 1 })
    for (const double x : { 0, WINDOW_SIDE - 1 })
    {
      const Eigen::Vector3d mapped = H * Eigen::Vector3d(x, y, 1);
      if (!(mapped.z() > 1e-9))
        return false;
      const Eigen::Vector2d corner = mapped.hnormalized();
      if (!(corner.x() >= 0.01 && corner.y() >= 0.01 && corner.x() < reference.cols - 1.01 &&
            corner.y() < reference.rows - 1.01))
        return false;
    }
  PatchWindow window;
  warpWindow(reference, H.cast<float>(), &window);
  makeTemplate(window, patch);
  return true;
}

/// Window of an image round a sub-pixel position; false where it leaves the image.
bool sampleWindow(const cv::Mat& image, const Eigen::Vector2d& center, PatchWindow* window)
{
  const Eigen::Vector2d whole = center.array().floor();
  const int u = static_cast<int>(whole.x()) - PATCH_HALF - 1;
  const int v = static_cast<int>(whole.y()) - PATCH_HALF - 1;
  if (!(u >= 0 && v >= 0 && u + WINDOW_SIDE < image.cols && v + WINDOW_SIDE < image.rows))
    return false;
  const Eigen::Vector2f rest = (center - whole).cast<float>();
  shiftWindow(image, u, v, rest.x(), rest.y(), window);
  return true;
}

/// One Gauss-Newton step for shift, gain and bias of I(x + d) = gain T(d) + bias; also the correlation at the start of
/// it.
bool solveStep(const PatchTemplate& patch, const PatchWindow& window, Eigen::Vector2d* step, float* correlation)
{
  constexpr float MIN_VARIANCE = 1;
  if (!(patch.variance > MIN_VARIANCE))
    return false;
  PatchDifference difference;
  comparePatch(patch, window, &difference);
  if (!(difference.variance > MIN_VARIANCE))
    return false;
  *correlation = difference.covariance / std::sqrt(patch.variance * difference.variance);
  Eigen::Matrix2d A;
  A << difference.a_xx, difference.a_xy, difference.a_xy, difference.a_yy;
  const double determinant = A.determinant();
  const double trace = A.trace();
  // An edge (one eigenvalue next to nothing) constrains the patch in one direction only.
  if (!(determinant > 0.005 * trace * trace) || difference.gain <= 0)
    return false;
  *step = -A.inverse() * Eigen::Vector2d(difference.b_x, difference.b_y);
  return true;
}

struct LevelOutcome
{
  bool converged = false;
  Eigen::Vector2d pixel;
  float correlation = 0;
};

LevelOutcome alignAtLevel(const PatchTemplate& patch, const cv::Mat& image, const Eigen::Vector2d& start,
                          const PatchRefinementOptions& options)
{
  LevelOutcome outcome;
  outcome.pixel = start;
  PatchWindow window;
  for (int iteration = 0; iteration < options.max_iterations && !outcome.converged; ++iteration)
  {
    Eigen::Vector2d step;
    if (!sampleWindow(image, outcome.pixel, &window) || !solveStep(patch, window, &step, &outcome.correlation))
      return outcome;
    outcome.pixel += step;
    if ((outcome.pixel - start).norm() > options.max_displacement_px)
      return outcome;
    // The correlation is that before the last step, which is too small to matter.
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
    const Eigen::Vector2d center = projected / scale;
    PatchTemplate patch;
    if (!warpTemplate(reference[reference_level], 1 << reference_level, scale, H_reference_current, center, &patch))
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

}  // namespace object_modelling::registration
