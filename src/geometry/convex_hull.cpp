#include "convex_hull.h"

extern "C"
{
#include <libqhull_r/qhull_ra.h>
}

#include "object_modelling/geometry/plane.h"

namespace object_modelling::geometry
{
namespace
{
/// Owns Qhull's state; its C interface needs both calls to give everything back.
class Qhull
{
public:
  Qhull() { qh_zero(&state_, nullptr); }
  ~Qhull()
  {
    qh_freeqhull(&state_, !qh_ALL);
    int current = 0;
    int total = 0;
    qh_memfreeshort(&state_, &current, &total);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool run(std::vector<coordT>* coordinates)
  {
    char command[] = "qhull Pp";
    const int count = static_cast<int>(coordinates->size() / 3);
    return qh_new_qhull(&state_, 3, count, coordinates->data(), False, command, nullptr, nullptr) == 0;
  }
  qhT* state() { return &state_; }

private:
  qhT state_;
};

ConvexHull flatHull(const std::vector<Eigen::Vector3f>& points)
{
  ConvexHull hull;
  hull.vertices = points;
  std::vector<Eigen::Vector3d> precise;
  for (const Eigen::Vector3f& p : points)
    precise.push_back(p.cast<double>());
  Plane plane;
  if (fitPlane(precise, Eigen::Vector3d::Zero(), &plane))
    hull.normals = { plane.normal, -plane.normal };
  else
    hull.normals = { Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ() };
  return hull;
}

}  // namespace

ConvexHull convexHull(const std::vector<Eigen::Vector3f>& points)
{
  if (points.size() < 4)
    return flatHull(points);
  std::vector<coordT> coordinates;
  coordinates.reserve(3 * points.size());
  for (const Eigen::Vector3f& p : points)
    coordinates.insert(coordinates.end(), { p.x(), p.y(), p.z() });
  Qhull qhull;
  if (!qhull.run(&coordinates))
    return flatHull(points);
  ConvexHull hull;
  qhT* qh = qhull.state();
  const facetT* facet = nullptr;
  FORALLfacets
  {
    hull.normals.emplace_back(facet->normal[0], facet->normal[1], facet->normal[2]);
  }
  const vertexT* vertex = nullptr;
  FORALLvertices
  {
    hull.vertices.push_back(points[static_cast<std::size_t>(qh_pointid(qh, vertex->point))]);
  }
  return hull;
}

}  // namespace object_modelling::geometry
