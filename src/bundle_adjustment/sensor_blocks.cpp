#include "sensor_blocks.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

namespace object_modelling::bundle_adjustment
{
namespace
{
// Prior: tolerances of sensors as manufactured. What no observation determines keeps its value and these sigmas.
constexpr double COLOR_OFFSET_SIGMA_PX = 1;
constexpr double FOCAL_SIGMA_RATIO = 0.02;
constexpr double PRINCIPAL_SIGMA_PX = 10;
constexpr double DEPTH_SIGMA_RATIO = 0.02;
constexpr double DEPTH_OFFSET_SIGMA_M = 0.01;

constexpr double DISTORTION_SIGMA_RATIO = 0.003;
constexpr double DISTORTION_SMOOTHNESS_RATIO = 0.003;  ///< second differences of neighbouring knots
constexpr double DISTORTION_MEAN_SIGMA_RATIO = 1e-5;

using Grid = rgbd::DistortionGrid;
using Vector1d = Eigen::Matrix<double, 1, 1>;

/// Weighted sum of knots.
class KnotSum
{
public:
  KnotSum(std::vector<double> factors, double sigma) : factors_(std::move(factors)), sigma_(sigma) {}
  template <typename T>
  bool operator()(T const* const* knots, T* residual) const
  {
    residual[0] = T(0);
    for (std::size_t i = 0; i < factors_.size(); ++i)
      residual[0] += T(factors_[i] / sigma_) * knots[i][0];
    return true;
  }

private:
  std::vector<double> factors_;
  double sigma_;
};

void addKnotSum(const std::vector<double>& factors, const std::vector<double*>& knots, double sigma,
                ceres::Problem* problem)
{
  auto* cost = new ceres::DynamicAutoDiffCostFunction<KnotSum>(new KnotSum(factors, sigma));
  for (std::size_t i = 0; i < knots.size(); ++i)
    cost->AddParameterBlock(1);
  cost->SetNumResiduals(1);
  problem->AddResidualBlock(cost, nullptr, knots);
}

void addDistortionPriors(Grid::Ratios* ratios, ceres::Problem* problem, ceres::ParameterBlockOrdering* ordering)
{
  std::vector<double*> all;
  for (double& ratio : *ratios)
    all.push_back(&ratio);
  const std::vector<double> bend = { 1, -2, 1 };
  for (int row = 0; row < Grid::ROWS; ++row)
    for (int column = 0; column < Grid::COLUMNS; ++column)
    {
      double* knot = all[row * Grid::COLUMNS + column];
      addKnotSum({ 1 }, { knot }, DISTORTION_SIGMA_RATIO, problem);
      if (column > 0 && column + 1 < Grid::COLUMNS)
        addKnotSum(bend, { knot - 1, knot, knot + 1 }, DISTORTION_SMOOTHNESS_RATIO, problem);
      if (row > 0 && row + 1 < Grid::ROWS)
        addKnotSum(bend, { knot - Grid::COLUMNS, knot, knot + Grid::COLUMNS }, DISTORTION_SMOOTHNESS_RATIO, problem);
      ordering->AddElementToGroup(knot, 1);
    }
  // All knots together are the ratio of depth.
  addKnotSum(std::vector<double>(Grid::KNOTS, 1.0 / Grid::KNOTS), all, DISTORTION_MEAN_SIGMA_RATIO, problem);
}

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
  distortion_ratio = sensor.depth_distortion_ratio;
}

void SensorBlocks::addDepthCost(std::unique_ptr<DepthCost> cost, const Eigen::Vector2d& pixel,
                                const geometry::PinholeCamera& camera, const BundleSolverOptions& options,
                                ceres::LossFunction* loss, double* motion, double* landmark, ceres::Problem* problem)
{
  if (!options.calibrate_depth_distortion)
  {
    problem->AddResidualBlock(cost.release(), loss, motion, landmark, color_offset_px.data(), &depth_growth,
                              &depth_offset_m);
    return;
  }
  const Grid::Shares around = Grid::sharesAt(pixel.x(), pixel.y(), camera.width, camera.height);
  double* knots[4];
  for (int i = 0; i < 4; ++i)
    knots[i] = &distortion_ratio[around.knot[i]];
  problem->AddResidualBlock(new DistortedDepthCost(std::move(cost), around.share), loss, motion, landmark,
                            color_offset_px.data(), &depth_growth, &depth_offset_m, knots[0], knots[1], knots[2],
                            knots[3]);
}

void SensorBlocks::finish(const BundleSolverOptions& options, ceres::Problem* problem,
                          ceres::ParameterBlockOrdering* ordering)
{
  const auto finish_block = [&](bool calibrate, const auto& sigma, double* block)
  {
    if (!problem->HasParameterBlock(block))
      return;
    ordering->AddElementToGroup(block, 1);
    if (calibrate)
      addPrior(sigma, block, problem);
    else
      problem->SetParameterBlockConstant(block);
  };
  // Where no depth has a slope only the prior constrains the offset of the colour images.
  finish_block(options.calibrate_color_offset, Eigen::Vector2d(COLOR_OFFSET_SIGMA_PX, COLOR_OFFSET_SIGMA_PX),
               color_offset_px.data());
  finish_block(options.calibrate_intrinsics,
               Eigen::Vector4d(FOCAL_SIGMA_RATIO, FOCAL_SIGMA_RATIO, PRINCIPAL_SIGMA_PX, PRINCIPAL_SIGMA_PX),
               intrinsics.data());
  finish_block(options.calibrate_depth_ratio, Vector1d(DEPTH_SIGMA_RATIO), &depth_growth);
  if (options.calibrate_depth_distortion)
    addDistortionPriors(&distortion_ratio, problem, ordering);
  finish_block(options.calibrate_depth_offset, Vector1d(DEPTH_OFFSET_SIGMA_M), &depth_offset_m);
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
  sensor.depth_distortion_ratio = distortion_ratio;
  if (!options.calibratesSensor())
    return;
  ceres::Covariance::Options covariance_options;
  covariance_options.algorithm_type = ceres::SPARSE_QR;
  covariance_options.num_threads = options.threads;
  ceres::Covariance covariance(covariance_options);
  std::vector<std::pair<const double*, const double*>> wanted;
  // Ceres before 2 takes no const pointer.
  const auto calibrated = [&](const double* block)
  { return problem->HasParameterBlock(block) && !problem->IsParameterBlockConstant(const_cast<double*>(block)); };
  for (const double* block : { static_cast<const double*>(intrinsics.data()), &depth_growth, &depth_offset_m })
    if (calibrated(block))
      wanted.emplace_back(block, block);
  for (const double& knot : distortion_ratio)
    if (calibrated(&knot))
      wanted.emplace_back(&knot, &knot);
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
  for (int i = 0; i < Grid::KNOTS; ++i)
    sensor.depth_distortion_sigma_ratio[i] = sigmas(&distortion_ratio[i], 1)[0];
}

}  // namespace object_modelling::bundle_adjustment
