#pragma once

#include <cstdint>
#include <vector>

#include "observation.h"

namespace object_modelling::fusion
{
/// Observations sorted into cubic cells. Cells that follow each other along x lie next to each other in memory, so a
/// neighbourhood is a handful of runs.
class ObservationGrid
{
public:
  ObservationGrid(const std::vector<std::vector<Observation>>& observations_per_view, float cell_size_m);

  const std::vector<Observation>& observations() const { return observations_; }
  /// First observation of every cell, and the end.
  const std::vector<std::uint32_t>& cellStarts() const { return cell_starts_; }

  /// Calls visit(index, observation) for all observations in the cells that a cube of half edge `radius_m` round
  /// `center` touches.
  template <typename Visit>
  void forNeighbors(const Eigen::Vector3f& center, float radius_m, Visit visit) const
  {
    const Eigen::Array3i low = cellOf(center.array() - radius_m), high = cellOf(center.array() + radius_m);
    for (int z = low.z(); z <= high.z(); ++z)
    {
      for (int y = low.y(); y <= high.y(); ++y)
      {
        std::uint32_t begin = 0, end = 0;
        findRun(low.x(), high.x(), y, z, &begin, &end);
        for (std::uint32_t i = begin; i < end; ++i)
          visit(i, observations_[i]);
      }
    }
  }

private:
  Eigen::Array3i cellOf(const Eigen::Array3f& p) const { return (p * cells_per_m_).floor().cast<int>(); }
  static std::uint64_t keyOf(int x, int y, int z);
  void findRun(int x_low, int x_high, int y, int z, std::uint32_t* begin, std::uint32_t* end) const;

  float cells_per_m_;
  std::vector<Observation> observations_;
  std::vector<std::uint64_t> cell_keys_;    ///< ascending
  std::vector<std::uint32_t> cell_starts_;  ///< one more than cell_keys_
};

}  // namespace object_modelling::fusion
