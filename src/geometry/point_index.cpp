#include "object_modelling/geometry/point_index.h"

#include <algorithm>
#include <utility>

#include <nanoflann.hpp>

namespace object_modelling::geometry
{
class PointIndex::Implementation
{
public:
  explicit Implementation(const std::vector<Eigen::Vector3f>& points)
      : points_(points), tree_(3, *this, nanoflann::KDTreeSingleIndexAdaptorParams(10))
  {
    tree_.buildIndex();
  }

  // The interface that nanoflann asks for.
  std::size_t kdtree_get_point_count() const { return points_.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t axis) const
  {
    return points_[index][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }

  std::size_t find(const Eigen::Vector3f& query, std::size_t count, std::uint32_t* indices, float* distances) const
  {
    return tree_.knnSearch(query.data(), count, indices, distances);
  }
  std::vector<std::uint32_t> findWithin(const Eigen::Vector3f& query, float radius) const
  {
    std::vector<std::pair<std::uint32_t, float>> found;
    nanoflann::RadiusResultSet<float, std::uint32_t> result(radius * radius, found);
    tree_.findNeighbors(result, query.data(), {});
    std::vector<std::uint32_t> indices;
    indices.reserve(found.size());
    for (const auto& [index, squared_distance] : found)
      indices.push_back(index);
    std::sort(indices.begin(), indices.end());
    return indices;
  }

private:
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Implementation>, Implementation,
                                                   3, std::uint32_t>;
  const std::vector<Eigen::Vector3f>& points_;
  Tree tree_;
};

PointIndex::PointIndex(const std::vector<Eigen::Vector3f>& points) : implementation_(new Implementation(points))
{
}

PointIndex::~PointIndex() = default;

void PointIndex::nearest(const Eigen::Vector3f& query, std::size_t count, std::vector<Neighbour>* neighbours) const
{
  constexpr std::size_t MAX_COUNT = 32;
  std::uint32_t indices[MAX_COUNT];
  float distances[MAX_COUNT];
  const std::size_t found = implementation_->find(query, std::min(count, MAX_COUNT), indices, distances);
  neighbours->clear();
  for (std::size_t i = 0; i < found; ++i)
    neighbours->push_back({ indices[i], distances[i] });
}

std::vector<std::uint32_t> PointIndex::within(const Eigen::Vector3f& query, double radius_m) const
{
  return implementation_->findWithin(query, static_cast<float>(radius_m));
}

}  // namespace object_modelling::geometry
