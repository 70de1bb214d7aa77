#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "object_modelling/rgbd/sensor_noise_model.h"

namespace object_modelling::segmentation
{
/// Axial sigma of a noise model as a table: it is asked for at every pixel, and its arc cosine and root would cost more
/// than the rest of the segmentation. Immutable: one instance serves all threads.
class NoiseTable
{
public:
  explicit NoiseTable(const rgbd::SensorNoiseModel& model);

  /// The table of a model. Those of the last few models are kept, for the segmentation of a frame needs it several
  /// times.
  static std::shared_ptr<const NoiseTable> of(const rgbd::SensorNoiseModel& model);

  /// cos_theta in [0, 1], of the angle between normal and viewing ray; clamped at 85 deg, where the model diverges.
  float sigma_m(float z_m, float cos_theta) const
  {
    const int row = static_cast<int>(z_m * PER_METER);
    const int column = static_cast<int>(cos_theta * COLUMNS);
    return sigma_[(row < 0       ? 0
                   : row >= ROWS ? ROWS - 1
                                 : row) *
                      COLUMNS +
                  (column < 0          ? 0
                   : column >= COLUMNS ? COLUMNS - 1
                                       : column)];
  }
  /// Standard deviation of a measured point along the normal `n` (unit length) of the surface that it lies on.
  float sigmaAlong_m(const Eigen::Vector3f& n, const Eigen::Vector3f& p_camera) const
  {
    const float projection = std::abs(n.dot(p_camera));
    return sigma_m(p_camera.z(), projection / p_camera.norm()) * projection / p_camera.z();
  }

private:
  static constexpr int PER_METER = 100;
  static constexpr int ROWS = 8 * PER_METER;
  static constexpr int COLUMNS = 128;
  std::vector<float> sigma_;
};

}  // namespace object_modelling::segmentation
