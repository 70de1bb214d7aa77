#include "sensor_blocks.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

namespace object_modelling::refinement
{
namespace
{
// As sensors come from the factory. What no sight tells stays where it is, and has these sigmas.
constexpr double COLOR_OFFSET_SIGMA_PX = 1;
constexpr double FOCAL_SIGMA_RATIO = 0.02;
constexpr double PRINCIPAL_SIGMA_PX = 10;
constexpr double DEPTH_SIGMA_RATIO = 0.02;
constexpr double DEPTH_OFFSET_SIGMA_M = 0.01;

using Vector1d = Eigen::Matrix<double, 1, 1>;

template <int SIZE>
void addPrior(const Eigen::Matrix<double, SIZE, 1>& sigma, double* block, ceres::Problem* problem)
{
  const Eigen::MatrixXd weight = sigma.cwiseInverse().asDiagonal();
  problem->AddResidualBlock(new ceres::NormalPrior(weight, Eigen::VectorXd::Zero(SIZE)), nullptr, block);
}
}  // namespace

SensorBlocks::SensorBlocks(const BundleState& state) : color_offset_px(state.color_offset_px)
{
  const rgbd::SensorCorrection& sensor = state.sensor;
  intrinsics << sensor.focal_ratio - Eigen::Vector2d::Ones(), sensor.principal_shift_px;
  depth_growth = sensor.depth_ratio - 1;
  depth_offset_m = sensor.depth_offset_m;
}

void SensorBlocks::finish(const BundleSolverOptions& options, ceres::Problem* problem,
                          ceres::ParameterBlockOrdering* ordering)
{
  const auto finishBlock = [&](bool calibrate, const auto& sigma, double* block)
  {
    if (!problem->HasParameterBlock(block))
      return;
    ordering->AddElementToGroup(block, 1);
    if (calibrate)
      addPrior(sigma, block, problem);
    else
      problem->SetParameterBlockConstant(block);
  };
  // Where no depth has a slope nothing but the prior tells the offset of the colour images.
  finishBlock(options.calibrate_color_offset, Eigen::Vector2d(COLOR_OFFSET_SIGMA_PX, COLOR_OFFSET_SIGMA_PX),
              color_offset_px.data());
  finishBlock(options.calibrate_intrinsics,
              Eigen::Vector4d(FOCAL_SIGMA_RATIO, FOCAL_SIGMA_RATIO, PRINCIPAL_SIGMA_PX, PRINCIPAL_SIGMA_PX),
              intrinsics.data());
  finishBlock(options.calibrate_depth_ratio, Vector1d(DEPTH_SIGMA_RATIO), &depth_growth);
  finishBlock(options.calibrate_depth_offset, Vector1d(DEPTH_OFFSET_SIGMA_M), &depth_offset_m);
}

void SensorBlocks::store(const BundleSolverOptions& options, ceres::Problem* problem, BundleState* state) const
{
  state->color_offset_px = color_offset_px;
  rgbd::SensorCorrection& sensor = state->sensor;
  sensor = {};
  sensor.focal_ratio = Eigen::Vector2d::Ones() + intrinsics.head<2>();
  sensor.principal_shift_px = intrinsics.tail<2>();
  sensor.depth_ratio = 1 + depth_growth;
  sensor.depth_offset_m = depth_offset_m;
  if (!options.calibratesSensor())
    return;
  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::SPARSE_QR;
  covariance_options.num_threads = options.threads;
  ceres::Covariance covariance(covariance_options);
  std::vector<std::pair<const double*, const double*>> wanted;
  const auto calibrated = [&](const double* block)
  { return problem->HasParameterBlock(block) && !problem->IsParameterBlockConstant(block); };
  for (const double* block : { intrinsics.data(), &depth_growth, &depth_offset_m })
    if (calibrated(block))
      wanted.emplace_back(block, block);
  const bool computed = !wanted.empty() && covariance.Compute(wanted, problem);
  const auto sigmas = [&](const double* block, int size)
  {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    if (calibrated(block) && !(computed && covariance.GetCovarianceBlock(block, block, matrix.data())))
      matrix.setConstant(std::numeric_limits<double>::quiet_NaN());
    return Eigen::VectorXd(matrix.diagonal().cwiseSqrt());
  };
  const Eigen::VectorXd of_intrinsics = sigmas(intrinsics.data(), 4);
  sensor.focal_ratio_sigma = of_intrinsics.head<2>();
  sensor.principal_shift_sigma_px = of_intrinsics.tail<2>();
  sensor.depth_ratio_sigma = sigmas(&depth_growth, 1)[0];
  sensor.depth_offset_sigma_m = sigmas(&depth_offset_m, 1)[0];
}

}  // namespace object_modelling::refinement
