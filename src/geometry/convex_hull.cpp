#include "object_modelling/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <string>

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

  /// `command`: "qhull" and its options.
  bool run(std::vector<Eigen::Vector3d>* points, std::string command)
  {
    static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(coordT), "Qhull reads points as a flat array");
    const int count = static_cast<int>(points->size());
    return qh_new_qhull(&state_, 3, count, points->front().data(), False, command.data(), nullptr, nullptr) == 0;
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

std::vector<Eigen::Vector3d> inDouble(const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3d> precise;
  precise.reserve(points.size());
  for (const Eigen::Vector3f& p : points)
    precise.push_back(p.cast<double>());
  return precise;
}

/// Of a hull all of whose facets are triangles.
HullSurface surfaceOf(Qhull* qhull, const std::vector<Eigen::Vector3f>& points)
{
  HullSurface hull;
  qhT* qh = qhull->state();
  std::vector<int> index_of_point(points.size(), -1);
  const auto indexOf = [&](const void* vertex)
  {
    int& index = index_of_point[static_cast<std::size_t>(qh_pointid(qh, static_cast<const vertexT*>(vertex)->point))];
    if (index < 0)
    {
      index = static_cast<int>(hull.vertices.size());
      hull.vertices.push_back(points[static_cast<std::size_t>(&index - index_of_point.data())]);
    }
    return static_cast<std::uint32_t>(index);
  };
  const facetT* facet = nullptr;
  FORALLfacets
  {
    const setT* corners = facet->vertices;
    std::array<std::uint32_t, 3> triangle{ indexOf(corners->e[0].p), indexOf(corners->e[1].p),
                                           indexOf(corners->e[2].p) };
    if ((facet->toporient != 0) != (qh_ORIENTclock != 0))
      std::swap(triangle[1], triangle[2]);
    hull.triangles.push_back(triangle);
  }
  return hull;
}
}  // namespace

ConvexHull convexHull(const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3d> precise = inDouble(points);
  Plane plane;
  if (!fitPlane(precise, Eigen::Vector3d::Zero(), &plane))
    return { points, { Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ() } };
  ConvexHull both_sides{ points, { plane.normal, -plane.normal } };
  Qhull qhull;
  if (isFlat(precise, plane) || !qhull.run(&precise, "qhull Pp"))
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

double HullSurface::volume_m3() const
{
  double volume = 0;
  for (const auto& [a, b, c] : triangles)
  {
    const Eigen::Vector3d origin = vertices.front().cast<double>();  // near: the products stay small
    volume += (vertices[a].cast<double>() - origin)
                  .dot((vertices[b].cast<double>() - origin).cross(vertices[c].cast<double>() - origin)) /
              6;
  }
  return volume;
}

HullSurface hullSurface(const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3d> precise = inDouble(points);
  Plane plane;
  if (!fitPlane(precise, Eigen::Vector3d::Zero(), &plane) || isFlat(precise, plane))
    return {};
  {
    Qhull qhull;
    if (qhull.run(&precise, "qhull Qt Pp"))
      return surfaceOf(&qhull, points);
  }
  // Many points that are coplanar but for rounding: joggled they are not.
  Qhull joggled;
  return joggled.run(&precise, "qhull QJ Pp") ? surfaceOf(&joggled, points) : HullSurface{};
}

}  // namespace object_modelling::geometry
