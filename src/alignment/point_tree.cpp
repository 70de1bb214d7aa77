#include "point_tree.h"

#include <algorithm>

#include <nanoflann.hpp>

namespace object_modelling::alignment
{
namespace
{
constexpr std::size_t LEAF_SIZE = 16;

/// What nanoflann asks of a set of points.
struct Points
{
  const std::vector<Eigen::Vector3f>& all;

  std::size_t kdtree_get_point_count() const { return all.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t dimension) const
  {
    return all[index][static_cast<Eigen::Index>(dimension)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }
};
}  // namespace

struct PointTree::Index
{
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3>;
  explicit Index(const std::vector<Eigen::Vector3f>& all) : points{ all }, tree(3, points, { LEAF_SIZE })
  {
    tree.buildIndex();
  }
  Points points;
  Tree tree;
};

PointTree::PointTree(const std::vector<Eigen::Vector3f>& points) : index_(std::make_unique<Index>(points))
{
}
PointTree::~PointTree() = default;

std::vector<int> PointTree::within(const Eigen::Vector3f& query, double radius_m) const
{
  std::vector<std::pair<std::size_t, float>> found;
  const auto squared = static_cast<float>(radius_m * radius_m);
  nanoflann::RadiusResultSet<float, std::size_t> result(squared, found);
  index_->tree.findNeighbors(result, query.data(), {});
  std::vector<int> indices;
  indices.reserve(found.size());
  for (const auto& [index, distance] : found)
    indices.push_back(static_cast<int>(index));
  std::sort(indices.begin(), indices.end());
  return indices;
}

}  // namespace object_modelling::alignment
