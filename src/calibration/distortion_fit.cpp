#include "distortion_fit.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <Eigen/Dense>

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::calibration
{
namespace
{
using Grid = rgbd::DistortionGrid;
constexpr int COLUMNS = Grid::COLUMNS, ROWS = Grid::ROWS, KNOTS = Grid::KNOTS;
constexpr double OFFSET_SIGMA_RATIO = 0.0003;  ///< of a block's offset: its noise, and what the knots cannot follow
constexpr double PRIOR_RATIO = 0.01;
constexpr double SMOOTHNESS_RATIO = 0.003;  ///< second differences of neighbouring knots
constexpr double MIN_GAIN_RATIO = 0.05;     ///< of the flatness in frames that were not fitted to
constexpr int MIN_BLOCKS = 8;

struct Image
{
  int width_px = 0, height_px = 0;
};

/// Columns of the plane's nuisance parameters and of the knots for the blocks of one view.
struct ViewEquations
{
  Eigen::MatrixXd knots;    ///< blocks x KNOTS
  Eigen::MatrixXd plane;    ///< blocks x 3
  Eigen::VectorXd offsets;  ///< measured
};

ViewEquations equationsOf(const WallView& view, const Image& image)
{
  const auto count = static_cast<Eigen::Index>(view.blocks.size());
  ViewEquations equations{ Eigen::MatrixXd::Zero(count, KNOTS), Eigen::MatrixXd(count, 3), Eigen::VectorXd(count) };
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const WallBlock& block = view.blocks[i];
    const Grid::Shares around = Grid::sharesAt(block.u_px, block.v_px, image.width_px, image.height_px);
    for (std::size_t k = 0; k < around.knot.size(); ++k)
      equations.knots(i, around.knot[k]) = around.share[k];
    // A change of the plane's inverse depth by dw changes depth by the share -z dw.
    equations.plane.row(i) << block.z_m * block.u_px / image.width_px, block.z_m * block.v_px / image.height_px,
        block.z_m;
    equations.offsets[i] = block.offset_ratio;
  }
  return equations;
}

/// What no plane explains.
Eigen::MatrixXd withoutPlane(const Eigen::MatrixXd& plane, const Eigen::MatrixXd& columns)
{
  return columns - plane * geometry::leastSquares(plane, columns);
}

void addSmoothness(Eigen::MatrixXd* A)
{
  const double weight = 1 / (SMOOTHNESS_RATIO * SMOOTHNESS_RATIO);
  const auto add = [&](int before, int at, int after)
  {
    const int knots[] = { before, at, after };
    const double factors[] = { 1, -2, 1 };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        (*A)(knots[i], knots[j]) += weight * factors[i] * factors[j];
  };
  for (int row = 0; row < ROWS; ++row)
    for (int column = 0; column < COLUMNS; ++column)
    {
      const int knot = row * COLUMNS + column;
      if (column > 0 && column + 1 < COLUMNS)
        add(knot - 1, knot, knot + 1);
      if (row > 0 && row + 1 < ROWS)
        add(knot - COLUMNS, knot, knot + COLUMNS);
    }
}

Eigen::VectorXd fitKnots(const std::vector<ViewEquations>& views)
{
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(KNOTS, KNOTS) / (PRIOR_RATIO * PRIOR_RATIO);
  addSmoothness(&A);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(KNOTS);
  const double weight = 1 / (OFFSET_SIGMA_RATIO * OFFSET_SIGMA_RATIO);
  for (const ViewEquations& view : views)
  {
    const Eigen::MatrixXd knots = withoutPlane(view.plane, view.knots);
    A += weight * knots.transpose() * knots;
    b += weight * knots.transpose() * view.offsets;
  }
  return geometry::solveSymmetric(A, b);
}

double flatness(const std::vector<ViewEquations>& views, const Eigen::VectorXd& knots)
{
  double sum = 0, count = 0;
  for (const ViewEquations& view : views)
  {
    const Eigen::MatrixXd rest = withoutPlane(view.plane, view.offsets - view.knots * knots);
    sum += rest.squaredNorm();
    count += static_cast<double>(rest.rows()) - 3;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

void fitDistortion(const std::vector<WallView>& views, int width_px, int height_px, NoiseCalibration* calibration)
{
  std::vector<ViewEquations> equations;
  for (const WallView& view : views)
    if (view.blocks.size() >= MIN_BLOCKS)
      equations.push_back(equationsOf(view, { width_px, height_px }));
  CoefficientReport report{ "depth_distortion_ratio", false, "" };
  if (equations.size() < 4)
  {
    report.reason = "too few frames show much of the wall";
    calibration->coefficients.push_back(report);
    return;
  }
  // Frames that follow each other are alike: whole halves of the recording are held out, not every second frame.
  const std::size_t half = equations.size() / 2;
  const std::vector<ViewEquations> first(equations.begin(), equations.begin() + static_cast<std::ptrdiff_t>(half));
  const std::vector<ViewEquations> second(equations.begin() + static_cast<std::ptrdiff_t>(half), equations.end());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(KNOTS);
  calibration->flatness_before_ratio = std::hypot(flatness(first, none), flatness(second, none)) / M_SQRT2;
  calibration->flatness_after_ratio =
      std::hypot(flatness(first, fitKnots(second)), flatness(second, fitKnots(first))) / M_SQRT2;
  std::ostringstream text;
  text << std::setprecision(2) << "blocks of the wall are " << 100 * calibration->flatness_before_ratio
       << " % of depth off its plane (RMS), " << 100 * calibration->flatness_after_ratio
       << " % with the distortion taken off, in frames that it was not fitted to";
  report.reason = text.str();
  report.fitted = calibration->flatness_after_ratio < (1 - MIN_GAIN_RATIO) * calibration->flatness_before_ratio;
  if (report.fitted)
  {
    const Eigen::VectorXd knots = fitKnots(equations);
    for (int i = 0; i < KNOTS; ++i)
      calibration->model.depth_distortion_ratio[i] = std::min(0.2, std::max(-0.2, knots[i]));
  }
  calibration->coefficients.push_back(report);
}

}  // namespace object_modelling::calibration
