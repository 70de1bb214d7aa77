#include "sigma_fit.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>
#include <utility>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::calibration
{
namespace
{
constexpr double BIN_M = 0.1;
constexpr double BIN_RAD = M_PI / 36;
constexpr double BASE_UP_TO_RAD = M_PI / 4;  ///< beyond, the slope turns lateral errors into depth
constexpr int MIN_BINS = 3;
constexpr int MIN_GRAZING_BINS = 2;

std::string rangeText(double low_m, double high_m)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << low_m << " to " << high_m << " m";
  return text.str();
}

struct Growth
{
  bool fitted = false;
  double constant_m = 0, quadratic_per_m = 0;
};

/// sigma = constant + quadratic (z - vertex)^2 through the bins, both not negative.
Growth fitGrowth(const std::vector<const NoiseBin*>& bins, const rgbd::SensorNoiseModel& model, bool with_growth)
{
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double share = 0, weight = 0;
  for (const NoiseBin* bin : bins)
  {
    const double beyond_m = bin->z_m - model.axial_vertex_m;
    const Eigen::Vector2d row(1 / bin->sigma_m, beyond_m * beyond_m / bin->sigma_m);
    A += row * row.transpose();
    b += row;
    share += row[0] * (1 - model.axial_quadratic_per_m * row[1]);
    weight += row[0] * row[0];
  }
  Growth growth;
  growth.quadratic_per_m = model.axial_quadratic_per_m;
  growth.constant_m = share / weight;
  if (with_growth)
  {
    const Eigen::Vector2d both = geometry::solveSymmetric(A, b);
    if (both.allFinite() && both[0] > 0 && both[1] >= 0)
      return { true, both[0], both[1] };
  }
  growth.constant_m = std::max(growth.constant_m, 1e-5);
  return growth;
}

void fitGrazing(const NoiseCalibrationOptions& options, NoiseCalibration* calibration)
{
  rgbd::SensorNoiseModel& model = calibration->model;
  rgbd::SensorNoiseModel base = model, unit = model;
  base.axial_grazing_m_sqrt_m = 0;
  unit.axial_grazing_m_sqrt_m = 1;
  double numerator = 0, denominator = 0;
  int count = 0;
  for (const NoiseBin& bin : calibration->bins)
  {
    if (bin.theta_rad < options.grazing_from_rad)
      continue;
    const double base_m = base.axialSigma_m(bin.z_m, bin.theta_rad);
    const double shape = (unit.axialSigma_m(bin.z_m, bin.theta_rad) - base_m) / bin.sigma_m;
    numerator += shape * (bin.sigma_m - base_m) / bin.sigma_m;
    denominator += shape * shape;
    ++count;
  }
  CoefficientReport report{ "axial_grazing_m_sqrt_m", count >= MIN_GRAZING_BINS, "" };
  if (report.fitted)
  {
    model.axial_grazing_m_sqrt_m = std::clamp(numerator / denominator, 0.0, 0.1);
    report.reason = std::to_string(count) + " bins of distance and angle";
  }
  else
    report.reason = "the wall was hardly seen at more than 65 deg from its normal: move to the side";
  calibration->coefficients.push_back(report);
}

}  // namespace

std::vector<NoiseBin> binned(const std::vector<WallBlock>& blocks, int min_blocks_per_bin)
{
  std::map<std::pair<int, int>, std::vector<const WallBlock*>> cells;
  for (const WallBlock& block : blocks)
    cells[{ static_cast<int>(block.z_m / BIN_M), static_cast<int>(block.theta_rad / BIN_RAD) }].push_back(&block);
  std::vector<NoiseBin> bins;
  for (const auto& [cell, members] : cells)
  {
    if (static_cast<int>(members.size()) < min_blocks_per_bin)
      continue;
    NoiseBin bin;
    std::vector<double> sigmas_m;
    for (const WallBlock* block : members)
    {
      bin.z_m += block->z_m / static_cast<double>(members.size());
      bin.theta_rad += block->theta_rad / static_cast<double>(members.size());
      sigmas_m.push_back(block->sigma_m);
    }
    bin.sigma_m = base::median(&sigmas_m);
    bin.block_count = static_cast<int>(members.size());
    bins.push_back(bin);
  }
  return bins;
}

void fitAxialSigma(const NoiseCalibrationOptions& options, NoiseCalibration* calibration)
{
  std::vector<const NoiseBin*> base;
  for (const NoiseBin& bin : calibration->bins)
    if (bin.theta_rad <= BASE_UP_TO_RAD)
      base.push_back(&bin);
  CoefficientReport constant{ "axial_constant_m", !base.empty(), "" };
  CoefficientReport quadratic{ "axial_quadratic_per_m", false, "" };
  if (base.empty())
    constant.reason = quadratic.reason = "the wall was hardly seen at less than 45 deg from its normal: face it";
  else
  {
    const auto nearer = [](const NoiseBin* a, const NoiseBin* b) { return a->z_m < b->z_m; };
    const auto [nearest, farthest] = std::minmax_element(base.begin(), base.end(), nearer);
    const std::string range = rangeText((*nearest)->z_m, (*farthest)->z_m);
    const bool spans =
        static_cast<int>(base.size()) >= MIN_BINS && (*farthest)->z_m - (*nearest)->z_m >= options.min_distance_span_m;
    const Growth growth = fitGrowth(base, calibration->model, spans);
    calibration->model.axial_constant_m = std::min(growth.constant_m, 0.1);
    calibration->model.axial_quadratic_per_m = std::min(growth.quadratic_per_m, 1.0);
    constant.reason = std::to_string(base.size()) + " bins of distance and angle, " + range;
    quadratic.fitted = growth.fitted;
    quadratic.reason = growth.fitted ? constant.reason
                       : spans       ? "the noise does not grow with distance as the model says"
                                     : "distances of " + range + " are too close together: step back and forth";
  }
  calibration->coefficients.push_back(constant);
  calibration->coefficients.push_back(quadratic);
  fitGrazing(options, calibration);
  for (NoiseBin& bin : calibration->bins)
    bin.fitted_sigma_m = calibration->model.axialSigma_m(bin.z_m, bin.theta_rad);
}

}  // namespace object_modelling::calibration
