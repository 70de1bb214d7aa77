#include "nearest_points.h"

#include <vector>

#include "object_modelling/geometry/point_index.h"

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr int STEP_PX = 2;
}

struct NearestPoints::Tree
{
  explicit Tree(const IcpView& view)
  {
    for (int v = 0; v < view.size().height; v += STEP_PX)
      for (int u = 0; u < view.size().width; u += STEP_PX)
        if (view.has(u, v))
        {
          points.push_back(view.point(u, v));
          normals.push_back(view.normal(u, v));
        }
    if (!points.empty())
      index = std::make_unique<geometry::PointIndex>(points);
  }
  std::vector<Eigen::Vector3f> points, normals;
  std::unique_ptr<geometry::PointIndex> index;  // none without points
};

NearestPoints::NearestPoints(const IcpView& view) : tree_(std::make_unique<Tree>(view))
{
}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints& NearestPoints::operator=(NearestPoints&&) noexcept = default;

bool NearestPoints::find(const Eigen::Vector3f& p, Eigen::Vector3f* nearest, Eigen::Vector3f* normal) const
{
  if (!tree_->index)
    return false;
  const std::uint32_t index = tree_->index->nearest(p).index;
  *nearest = tree_->points[index];
  *normal = tree_->normals[index];
  return true;
}

}  // namespace object_modelling::multi_view_icp
