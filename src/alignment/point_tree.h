#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

namespace object_modelling::alignment
{
/// K-d tree over points, which must outlive it. Queries are safe from several threads.
class PointTree
{
public:
  explicit PointTree(const std::vector<Eigen::Vector3f>& points);
  ~PointTree();
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  /// Indices of the points within `radius_m`, ascending.
  std::vector<int> within(const Eigen::Vector3f& query, double radius_m) const;

private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace object_modelling::alignment
