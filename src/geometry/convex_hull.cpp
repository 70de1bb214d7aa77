#include "object_modelling/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>

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

  bool run(std::vector<Eigen::Vector3d>* points)
  {
    static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(coordT), "Qhull reads points as a flat array");
    char command[] = "qhull Pp";
    const int count = static_cast<int>(points->size());
    return qh_new_qhull(&state_, 3, count, points->front().data(), False, command, nullptr, nullptr) == 0;
  }
  qhT* state() { return &state_; }

private:
  qhT state_;
};

/// Points without volume, which Qhull refuses with pages of explanation.
bool isFlat(const std::vector<Eigen::Vector3d>& points, const Plane& plane)
{
  double off_plane_m = 0;
  double extent_m = 0;
  for (const Eigen::Vector3d& p : points)
  {
    off_plane_m = std::max(off_plane_m, std::abs(plane.signedDistance_m(p)));
    extent_m = std::max(extent_m, (p - points.front()).norm());
  }
  return off_plane_m <= 1e-6 * extent_m;
}

}  // namespace

ConvexHull convexHull(const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3d> precise;
  precise.reserve(points.size());
  for (const Eigen::Vector3f& p : points)
    precise.push_back(p.cast<double>());
  Plane plane;
  if (!fitPlane(precise, Eigen::Vector3d::Zero(), &plane))
    return { points, { Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ() } };
  ConvexHull both_sides{ points, { plane.normal, -plane.normal } };
  Qhull qhull;
  if (isFlat(precise, plane) || !qhull.run(&precise))
    return both_sides;
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
