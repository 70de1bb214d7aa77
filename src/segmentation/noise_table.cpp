#include "noise_table.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace object_modelling::segmentation
{
namespace
{
constexpr std::size_t KEPT_TABLES = 4;

struct KeptTable
{
  rgbd::SensorNoiseModel model;
  std::shared_ptr<const NoiseTable> table;
};
}  // namespace

std::shared_ptr<const NoiseTable> NoiseTable::of(const rgbd::SensorNoiseModel& model)
{
  static std::mutex mutex;
  static std::vector<KeptTable> kept;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found =
      std::find_if(kept.begin(), kept.end(), [&](const KeptTable& table) { return table.model == model; });
  if (found != kept.end())
    return found->table;
  if (kept.size() == KEPT_TABLES)
    kept.erase(kept.begin());
  kept.push_back({ model, std::make_shared<const NoiseTable>(model) });
  return kept.back().table;
}

NoiseTable::NoiseTable(const rgbd::SensorNoiseModel& model) : sigma_(ROWS * COLUMNS)
{
  constexpr double MAX_THETA_RAD = 1.4835298641951802;  // 85 deg
  for (int row = 0; row < ROWS; ++row)
    for (int column = 0; column < COLUMNS; ++column)
    {
      const double z_m = (row + 0.5) / PER_METER;
      const double theta_rad = std::min(MAX_THETA_RAD, std::acos((column + 0.5) / COLUMNS));
      sigma_[row * COLUMNS + column] = static_cast<float>(model.axialSigma_m(z_m, theta_rad));
    }
}

}  // namespace object_modelling::segmentation
