#include "nearest_points.h"

#include <nanoflann.hpp>

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr int STEP_PX = 2;
constexpr std::size_t LEAF_SIZE = 16;

/// What nanoflann asks of a set of points.
struct Points
{
  std::vector<Eigen::Vector3f> p, n;

  std::size_t kdtree_get_point_count() const { return p.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t dimension) const
  {
    return p[index][static_cast<Eigen::Index>(dimension)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }
};
}  // namespace

struct NearestPoints::Tree
{
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;
  explicit Tree(Points given) : points(std::move(given)), index(3, points, { LEAF_SIZE }) { index.buildIndex(); }
  Points points;
  Index index;
};

NearestPoints::NearestPoints(const IcpView& view)
{
  Points points;
  for (int v = 0; v < view.size().height; v += STEP_PX)
  {
    for (int u = 0; u < view.size().width; u += STEP_PX)
    {
      if (!view.has(u, v))
        continue;
      points.p.push_back(view.point(u, v));
      points.n.push_back(view.normal(u, v));
    }
  }
  if (!points.p.empty())
    tree_ = std::make_unique<Tree>(std::move(points));
}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints& NearestPoints::operator=(NearestPoints&&) noexcept = default;

bool NearestPoints::find(const Eigen::Vector3f& p, Eigen::Vector3f* nearest, Eigen::Vector3f* normal) const
{
  if (!tree_)
    return false;
  std::size_t index = 0;
  float squared_distance = 0;
  nanoflann::KNNResultSet<float> result(1);
  result.init(&index, &squared_distance);
  tree_->index.findNeighbors(result, p.data(), {});
  *nearest = tree_->points.p[index];
  *normal = tree_->points.n[index];
  return true;
}

}  // namespace object_modelling::multi_view_icp
