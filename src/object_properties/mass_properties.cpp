#include "object_modelling/object_properties/mass_properties.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "object_modelling/base/options.h"
#include "object_modelling/geometry/convex_hull.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr double MAX_SHARE_OF_HULL = 1.001;  // of rounding; a larger volume is that of triangles that overlap

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Surface
{
  std::vector<Eigen::Vector3d> vertices;
  Triangles triangles;
};

/// Vertices at one place joined, so that seams of colour or texture are no borders.
Surface joined(const mesh::TriangleMesh& mesh)
{
  Surface surface;
  std::map<std::tuple<float, float, float>, std::uint32_t> known;
  std::vector<std::uint32_t> index;
  for (const Eigen::Vector3f& v : mesh.vertices)
  {
    const auto next = static_cast<std::uint32_t>(surface.vertices.size());
    const auto [place, added] = known.insert({ { v.x(), v.y(), v.z() }, next });
    if (added)
      surface.vertices.push_back(v.cast<double>());
    index.push_back(place->second);
  }
  for (const auto& [a, b, c] : mesh.triangles)
    if (index[a] != index[b] && index[b] != index[c] && index[c] != index[a])
      surface.triangles.push_back({ index[a], index[b], index[c] });
  return surface;
}

/// Directed edges that no neighbour runs the other way, from their start.
std::multimap<std::uint32_t, std::uint32_t> openEdges(const Triangles& triangles)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;  // by ascending ends: runs up minus runs down
  for (const auto& triangle : triangles)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::uint32_t from = triangle[i], to = triangle[(i + 1) % 3];
      balance[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  std::multimap<std::uint32_t, std::uint32_t> edges;
  for (const auto& [ends, runs] : balance)
    for (int i = 0; i < std::abs(runs); ++i)
      edges.insert(runs > 0 ? ends : std::make_pair(ends.second, ends.first));
  return edges;
}

/// A fan round the middle of every border; takes the edges away.
void closeFlat(std::multimap<std::uint32_t, std::uint32_t> edges, Surface* surface)
{
  while (!edges.empty())
  {
    std::vector<std::uint32_t> loop{ edges.begin()->first };
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (auto edge = edges.begin(); edge != edges.end(); edge = edges.find(loop.back()))
    {
      sum += surface->vertices[edge->first];
      loop.push_back(edge->second);
      edges.erase(edge);
      if (loop.back() == loop.front())
        break;
    }
    const auto middle = static_cast<std::uint32_t>(surface->vertices.size());
    surface->vertices.emplace_back(sum / static_cast<double>(loop.size() - 1));
    for (std::size_t i = 0; i + 1 < loop.size(); ++i)
      surface->triangles.push_back({ loop[i + 1], loop[i], middle });
    if (loop.back() != loop.front())  // of triangles that face against each other
      surface->triangles.push_back({ loop.front(), loop.back(), middle });
  }
}

/// Volume, centre and inertia of what the triangles enclose.
void integrate(const Surface& surface, MassProperties* mass)
{
  const Eigen::Vector3d origin = surface.vertices.front();  // near: the products stay small
  double volume = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& triangle : surface.triangles)
  {
    const Eigen::Vector3d a = surface.vertices[triangle[0]] - origin, b = surface.vertices[triangle[1]] - origin,
                          c = surface.vertices[triangle[2]] - origin;
    const double six_volumes = a.dot(b.cross(c));
    const Eigen::Vector3d sum = a + b + c;
    volume += six_volumes / 6;
    first += six_volumes / 24 * sum;
    second += six_volumes / 120 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  mass->volume_m3 = volume;
  if (!(std::abs(volume) > 0))
    return;
  const Eigen::Vector3d center = first / volume;
  const Eigen::Matrix3d about_center = second - volume * center * center.transpose();
  mass->center_of_mass_m = origin + center;
  mass->inertia_per_density_m5 = about_center.trace() * Eigen::Matrix3d::Identity() - about_center;
}

Surface surfaceOf(const geometry::HullSurface& hull)
{
  Surface surface;
  for (const Eigen::Vector3f& vertex : hull.vertices)
    surface.vertices.push_back(vertex.cast<double>());
  surface.triangles = hull.triangles;
  return surface;
}
}  // namespace

std::vector<std::string> MassOptions::violations() const
{
  base::OptionsCheck check("mass_properties");
  check.positive("density_kg_m3", density_kg_m3);
  check.atLeast("mass_kg", mass_kg, 0.0);
  return check.violations();
}

MassProperties massProperties(const mesh::TriangleMesh& mesh, const MassOptions& options)
{
  base::checked(options);
  MassProperties mass;
  const geometry::HullSurface hull = geometry::hullSurface(mesh.vertices);
  if (hull.triangles.empty())
    return mass;
  Surface surface = joined(mesh);
  const std::multimap<std::uint32_t, std::uint32_t> borders = openEdges(surface.triangles);
  mass.closed = borders.empty();
  mass.of = mass.closed ? Solid::MESH : Solid::CLOSED_MESH;
  closeFlat(borders, &surface);
  integrate(surface, &mass);
  if (!(mass.volume_m3 > 0) || mass.volume_m3 > MAX_SHARE_OF_HULL * hull.volume_m3())
  {
    mass.of = Solid::HULL;
    integrate(surfaceOf(hull), &mass);
  }
  mass.mass_kg = options.mass_kg > 0 ? options.mass_kg : mass.volume_m3 * options.density_kg_m3;
  mass.density_kg_m3 = options.mass_kg > 0 ? options.mass_kg / mass.volume_m3 : options.density_kg_m3;
  return mass;
}

}  // namespace object_modelling::object_properties
