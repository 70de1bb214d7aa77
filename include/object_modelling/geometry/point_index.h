#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::geometry
{
/// Nearest neighbours among fixed points, which must outlive the index. Queries are safe from several threads.
class PointIndex
{
public:
  explicit PointIndex(const std::vector<Eigen::Vector3f>& points);
  ~PointIndex();

  struct Neighbour
  {
    std::uint32_t index = 0;
    float squared_distance = 0;
  };
  /// The `count` nearest, nearest first; fewer if there are fewer points.
  void nearest(const Eigen::Vector3f& query, std::size_t count, std::vector<Neighbour>* neighbours) const;
  /// Indices of the points nearer than `radius_m`, ascending.
  std::vector<std::uint32_t> within(const Eigen::Vector3f& query, double radius_m) const;

private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace object_modelling::geometry
