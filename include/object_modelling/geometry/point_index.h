#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::geometry
{
/// Nearest neighbours among fixed points, which must outlive the index. Queries are safe from several threads.
/// `Scalar`: float or double.
template <typename Scalar>
class PointIndexOf
{
public:
  using Point = Eigen::Matrix<Scalar, 3, 1>;
  explicit PointIndexOf(const std::vector<Point>& points);
  ~PointIndexOf();

  struct Neighbor
  {
    std::uint32_t index = 0;
    Scalar squared_distance = 0;
  };
  /// There must be points.
  Neighbor nearest(const Point& query) const;
  /// The `count` nearest, at most 32, nearest first; fewer if there are fewer points.
  void nearest(const Point& query, std::size_t count, std::vector<Neighbor>* neighbors) const;
  /// Indices of the points nearer than `radius_m`, ascending.
  std::vector<std::uint32_t> within(const Point& query, double radius_m) const;

private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

using PointIndex = PointIndexOf<float>;

}  // namespace object_modelling::geometry
