#include "object_modelling/geometry/point_index.h"

#include <algorithm>
#include <type_traits>

#include <nanoflann.hpp>

namespace object_modelling::geometry
{
template <typename Scalar>
class PointIndexOf<Scalar>::Implementation
{
public:
  explicit Implementation(const std::vector<Point>& points)
      : points_(points), tree_(3, *this, nanoflann::KDTreeSingleIndexAdaptorParams(10))
  {
    tree_.buildIndex();
  }

  // The interface that nanoflann requires.
  std::size_t kdtree_get_point_count() const { return points_.size(); }
  Scalar kdtree_get_pt(std::size_t index, std::size_t axis) const
  {
    return points_[index][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }

  std::size_t find(const Point& query, std::size_t count, std::uint32_t* indices, Scalar* distances) const
  {
    return tree_.knnSearch(query.data(), count, indices, distances);
  }
  std::vector<std::uint32_t> findWithin(const Point& query, Scalar radius) const
  {
    using ResultSet = nanoflann::RadiusResultSet<Scalar, std::uint32_t>;
    // Of pairs before nanoflann 1.5, of its own type since.
    std::remove_reference_t<decltype(ResultSet::m_indices_dists)> found;
    ResultSet result(radius * radius, found);
    tree_.findNeighbors(result, query.data(), {});
    std::vector<std::uint32_t> indices;
    indices.reserve(found.size());
    for (const auto& [index, squared_distance] : found)
      indices.push_back(index);
    std::sort(indices.begin(), indices.end());
    return indices;
  }

private:
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<Scalar, Implementation>, Implementation,
                                                   3, std::uint32_t>;
  const std::vector<Point>& points_;
  Tree tree_;
};

template <typename Scalar>
PointIndexOf<Scalar>::PointIndexOf(const std::vector<Point>& points) : implementation_(new Implementation(points))
{
}

template <typename Scalar>
PointIndexOf<Scalar>::~PointIndexOf() = default;

template <typename Scalar>
typename PointIndexOf<Scalar>::Neighbor PointIndexOf<Scalar>::nearest(const Point& query) const
{
  Neighbor found;
  implementation_->find(query, 1, &found.index, &found.squared_distance);
  return found;
}

template <typename Scalar>
void PointIndexOf<Scalar>::nearest(const Point& query, std::size_t count, std::vector<Neighbor>* neighbors) const
{
  constexpr std::size_t MAX_COUNT = 32;
  std::uint32_t indices[MAX_COUNT];
  Scalar distances[MAX_COUNT];
  const std::size_t found = implementation_->find(query, std::min(count, MAX_COUNT), indices, distances);
  neighbors->clear();
  for (std::size_t i = 0; i < found; ++i)
    neighbors->push_back({ indices[i], distances[i] });
}

template <typename Scalar>
std::vector<std::uint32_t> PointIndexOf<Scalar>::within(const Point& query, double radius_m) const
{
  return implementation_->findWithin(query, static_cast<Scalar>(radius_m));
}

template class PointIndexOf<float>;
template class PointIndexOf<double>;

}  // namespace object_modelling::geometry
