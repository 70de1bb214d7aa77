#pragma once

#include <memory>

#include "icp_view.h"

namespace object_modelling::multi_view_icp
{
/// Nearest points of one view's surface (k-d tree over every second pixel of every second row).
class NearestPoints
{
public:
  explicit NearestPoints(const IcpView& view);
  ~NearestPoints();
  NearestPoints(NearestPoints&&) noexcept;
  NearestPoints& operator=(NearestPoints&&) noexcept;
  /// False if the view has no points.
  bool find(const Eigen::Vector3f& p, Eigen::Vector3f* nearest, Eigen::Vector3f* normal) const;

private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace object_modelling::multi_view_icp
