#include "bias_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "object_modelling/geometry/linear_systems.h"

namespace object_modelling::calibration
{
namespace
{
constexpr double MAX_STAMP_DIFFERENCE_S = 0.05;
/// On a slanted wall a bias that is no share of depth bends and turns the plane.
constexpr double FRONTAL_THETA_RAD = 25 * M_PI / 180;
constexpr double APART_M = 0.2;  ///< closer distances count as one place
constexpr double SPAN_FOR_QUADRATIC_M = 1;

struct Reading
{
  double z_m = 0;     ///< measured, mean over the wall
  double bias_m = 0;  ///< of it
};

std::vector<Reading> readingsOf(const std::vector<WallView>& views, const std::vector<MeasuredDistance>& distances)
{
  std::vector<Reading> readings;
  for (const MeasuredDistance& distance : distances)
  {
    const auto nearest =
        std::min_element(views.begin(), views.end(),
                         [&](const WallView& a, const WallView& b)
                         { return std::abs(a.stamp_s - distance.stamp_s) < std::abs(b.stamp_s - distance.stamp_s); });
    if (nearest == views.end() || std::abs(nearest->stamp_s - distance.stamp_s) > MAX_STAMP_DIFFERENCE_S ||
        nearest->theta_rad(0, 0) > FRONTAL_THETA_RAD)
      continue;
    Reading reading;
    for (const WallBlock& block : nearest->blocks)
      reading.z_m += block.z_m / static_cast<double>(nearest->blocks.size());
    reading.bias_m = reading.z_m * (1 - distance.distance_m / nearest->distance_m());
    readings.push_back(reading);
  }
  return readings;
}

int coefficientCount(std::vector<Reading> readings)
{
  std::sort(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) { return a.z_m < b.z_m; });
  int places = 0;
  double last_m = 0;
  for (const Reading& reading : readings)
    if (places == 0 || reading.z_m - last_m >= APART_M)
    {
      ++places;
      last_m = reading.z_m;
    }
  const bool wide = readings.back().z_m - readings.front().z_m >= SPAN_FOR_QUADRATIC_M;
  return places >= 3 && wide ? 3 : std::min(places, 2);
}

}  // namespace

void fitBias(const std::vector<WallView>& views, const std::vector<MeasuredDistance>& distances,
             NoiseCalibration* calibration)
{
  CoefficientReport reports[] = { { "depth_bias_constant_m", false, "" },
                                  { "depth_bias_linear_ratio", false, "" },
                                  { "depth_bias_quadratic_per_m", false, "" } };
  double* const coefficients[] = { &calibration->model.depth_bias_constant_m,
                                   &calibration->model.depth_bias_linear_ratio,
                                   &calibration->model.depth_bias_quadratic_per_m };
  if (distances.empty())
    for (CoefficientReport& report : reports)
      report.reason = "a wall does not tell how far it is: give measured distances (--distances)";
  else
  {
    const std::vector<Reading> readings = readingsOf(views, distances);
    if (readings.empty())
      throw base::Error(base::StatusCode::BAD_INPUT,
                        "none of the " + std::to_string(distances.size()) +
                            " measured distances has the stamp (to 0.05 s) of a frame that faces the wall (to 25 deg)");
    const int count = coefficientCount(readings);
    Eigen::MatrixXd A(readings.size(), count);
    Eigen::VectorXd b(readings.size());
    for (std::size_t i = 0; i < readings.size(); ++i)
    {
      for (int k = 0; k < count; ++k)
        A(i, k) = std::pow(readings[i].z_m, k);
      b[i] = readings[i].bias_m;
    }
    const Eigen::VectorXd solution = geometry::leastSquares(A, b);
    for (int k = 0; k < 3; ++k)
    {
      reports[k].fitted = k < count;
      reports[k].reason = k < count ? std::to_string(readings.size()) + " measured distances"
                                    : "the measured distances are too few or too close together";
      if (k < count)
        *coefficients[k] = std::clamp(solution[k], -0.2, 0.2);
    }
  }
  calibration->coefficients.insert(calibration->coefficients.end(), std::begin(reports), std::end(reports));
}

}  // namespace object_modelling::calibration
