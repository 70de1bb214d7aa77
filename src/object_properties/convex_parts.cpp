#include "object_modelling/object_properties/convex_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "object_modelling/base/options.h"
#include "object_modelling/geometry/oriented_box.h"
#include "triangle_soup.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr int CUTS_PER_AXIS = 7;
constexpr double IMBALANCE_COST = 0.05;   // of volume, so that equal gains are taken in the middle
constexpr double MAX_JOINT_GROWTH = 0.1;  // of the volume of two parts that are joined
constexpr std::size_t MAX_SEARCH_TRIANGLES = 3000;
constexpr float SEARCH_CELL_RATIO = 0.016f;  // of the diagonal
constexpr std::size_t MAX_DIRECTIONS = 1500;
constexpr std::size_t ROUGH_DIRECTIONS = 100;
constexpr float HALF_SHEET_M = 0.0005f;  // what a flat part is taken for

/// In the frame of the object's box.
struct Part
{
  std::vector<Eigen::AlignedBox3f> regions;
  Soup soup;  ///< coarse
  geometry::HullSurface hull;
  double volume_m3 = 0;
  Hollow hollow;
};

Part partOf(std::vector<Eigen::AlignedBox3f> regions, Soup soup)
{
  Part part{ std::move(regions), std::move(soup), {}, 0, {} };
  part.hull = geometry::hullSurface(cornersOf(part.soup));
  part.volume_m3 = part.hull.volume_m3();
  part.hollow = deepestHollow(part.soup, part.hull);
  return part;
}

struct Cut
{
  int axis = -1;  ///< none
  float at_m = 0;
  double cost = std::numeric_limits<double>::infinity();
};

/// Places across an axis: even steps, and just above the floor of the deepest hollow.
std::vector<float> placesAlong(const Part& part, int axis, float clearance_m)
{
  Eigen::AlignedBox3f extent;
  for (const Eigen::Vector3f& vertex : part.hull.vertices)
    extent.extend(vertex);
  std::vector<float> places;
  for (int i = 1; i <= CUTS_PER_AXIS; ++i)
    places.push_back(extent.min()[axis] +
                     extent.sizes()[axis] * static_cast<float>(i) / static_cast<float>(CUTS_PER_AXIS + 1));
  if (std::abs(part.hollow.normal[axis]) > 0.5f)
    places.push_back(part.hollow.place[axis] + clearance_m * part.hollow.normal[axis]);
  return places;
}

/// Directions spread evenly over the sphere.
std::vector<Eigen::Vector3f> evenDirections(std::size_t count)
{
  std::vector<Eigen::Vector3f> directions;
  for (std::size_t i = 0; i < count; ++i)
  {
    // Fibonacci spiral
    const double z = 1 - (2 * static_cast<double>(i) + 1.0) / static_cast<double>(count), r = std::sqrt(1 - z * z),
                 turn = static_cast<double>(i) * M_PI * (3 - std::sqrt(5.0));
    directions.push_back(Eigen::Vector3d(r * std::cos(turn), r * std::sin(turn), z).cast<float>());
  }
  return directions;
}

/// Those furthest out along one of the directions.
std::vector<Eigen::Vector3f> extremes(const std::vector<Eigen::Vector3f>& points,
                                      const std::vector<Eigen::Vector3f>& directions)
{
  std::set<std::size_t> chosen;
  for (const Eigen::Vector3f& along : directions)
  {
    std::size_t furthest = 0;
    float largest = -std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].dot(along) > largest)
      {
        largest = points[i].dot(along);
        furthest = i;
      }
    chosen.insert(furthest);
  }
  std::vector<Eigen::Vector3f> result;
  for (const std::size_t index : chosen)
    result.push_back(points[index]);
  return result;
}

/// Of the hull of some extreme points: it is compared only.
double roughVolume_m3(const Soup& soup)
{
  static const std::vector<Eigen::Vector3f> DIRECTIONS = evenDirections(ROUGH_DIRECTIONS);
  return geometry::hullSurface(extremes(cornersOf(soup), DIRECTIONS)).volume_m3();
}

Cut bestCut(const Part& part, float clearance_m)
{
  Cut best;
  for (int axis = 0; axis < 3; ++axis)
    for (const float at_m : placesAlong(part, axis, clearance_m))
    {
      const Soup low = clipped(part.soup, axis, at_m, -1), high = clipped(part.soup, axis, at_m, 1);
      if (low.empty() || high.empty())
        continue;
      const double low_m3 = roughVolume_m3(low), high_m3 = roughVolume_m3(high);
      const double cost = low_m3 + high_m3 + IMBALANCE_COST * std::abs(low_m3 - high_m3);
      if (cost < best.cost)
        best = { axis, at_m, cost };
    }
  return best;
}

std::vector<Part> cutApart(const Soup& soup, const Eigen::AlignedBox3f& all, double tolerance_m, int max_parts)
{
  std::vector<Part> parts{ partOf({ all }, soup) };
  const auto shallower = [](const Part& a, const Part& b) { return a.hollow.depth_m < b.hollow.depth_m; };
  while (static_cast<int>(parts.size()) < max_parts)
  {
    const auto worst = std::max_element(parts.begin(), parts.end(), shallower);
    if (worst->hollow.depth_m <= tolerance_m)
      break;
    const Cut cut = bestCut(*worst, static_cast<float>(tolerance_m / 4));
    if (cut.axis < 0)
    {
      worst->hollow.depth_m = 0;  // stays as it is
      continue;
    }
    Eigen::AlignedBox3f low = worst->regions.front(), high = low;
    low.max()[cut.axis] = cut.at_m;
    high.min()[cut.axis] = cut.at_m;
    Part above = partOf({ high }, clipped(worst->soup, cut.axis, cut.at_m, 1));
    *worst = partOf({ low }, clipped(worst->soup, cut.axis, cut.at_m, -1));
    parts.push_back(std::move(above));
  }
  return parts;
}

bool touch(const Part& a, const Part& b)
{
  for (const Eigen::AlignedBox3f& of_a : a.regions)
    for (const Eigen::AlignedBox3f& of_b : b.regions)
      if (of_a.exteriorDistance(of_b) < 1e-6f)
        return true;
  return false;
}

/// The hull of both, if it fills no more than it may.
bool joined(const Part& a, const Part& b, double tolerance_m, Part* both)
{
  std::vector<Eigen::Vector3f> points = a.hull.vertices;
  points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
  const double volume_m3 = geometry::hullSurface(points).volume_m3();
  if (volume_m3 > (1 + MAX_JOINT_GROWTH) * (a.volume_m3 + b.volume_m3))
    return false;
  std::vector<Eigen::AlignedBox3f> regions = a.regions;
  regions.insert(regions.end(), b.regions.begin(), b.regions.end());
  Soup soup = a.soup;
  soup.insert(soup.end(), b.soup.begin(), b.soup.end());
  *both = partOf(std::move(regions), std::move(soup));
  return both->hollow.depth_m <= tolerance_m;
}

/// Joins neighbours as long as there are two that may be.
void join(double tolerance_m, std::vector<Part>* parts)
{
  for (std::size_t i = 0; i < parts->size(); ++i)
    for (std::size_t j = i + 1; j < parts->size(); ++j)
    {
      Part both;
      if (!touch((*parts)[i], (*parts)[j]) || !joined((*parts)[i], (*parts)[j], tolerance_m, &both))
        continue;
      (*parts)[i] = std::move(both);
      parts->erase(parts->begin() + static_cast<std::ptrdiff_t>(j));
      i = 0;
      j = 0;
    }
}

/// Points furthest out along even directions, as many as may be.
std::vector<Eigen::Vector3f> atMost(std::size_t max_count, const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3f> chosen;
  for (std::size_t count = MAX_DIRECTIONS; count > 3; count = count * 4 / 5)
  {
    chosen = extremes(points, evenDirections(count));
    if (chosen.size() <= max_count)
      break;
  }
  return chosen;
}

/// Hull of the fine surface within a part.
geometry::HullSurface finalHull(const Soup& fine, const Part& part, std::size_t max_vertices)
{
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::AlignedBox3f& region : part.regions)
  {
    const std::vector<Eigen::Vector3f> within = cornersOf(clipped(fine, region));
    points.insert(points.end(), within.begin(), within.end());
  }
  geometry::HullSurface hull = geometry::hullSurface(points);
  if (hull.triangles.empty() && points.size() > 2)
  {
    std::vector<Eigen::Vector3f> thick;
    for (const Eigen::Vector3f& point : points)
      for (int axis = 0; axis < 3; ++axis)
        for (const float side : { -HALF_SHEET_M, HALF_SHEET_M })
          thick.emplace_back(point + side * Eigen::Vector3f::Unit(axis));
    hull = geometry::hullSurface(thick);
  }
  // Points that stand out by rounding alone, along edges and on faces, are not among the extremes.
  return hull.vertices.empty() ? hull : geometry::hullSurface(atMost(max_vertices, hull.vertices));
}
}  // namespace

std::vector<std::string> ConvexPartsOptions::violations() const
{
  base::OptionsCheck check("convex_parts");
  check.positive("max_concavity_m", max_concavity_m);
  check.atLeast("max_concavity_ratio", max_concavity_ratio, 0.0);
  check.inRange("max_parts", max_parts, 1, 256);
  check.inRange("max_vertices", max_vertices, 8, 1024);
  return check.violations();
}

std::vector<mesh::TriangleMesh> convexParts(const mesh::TriangleMesh& mesh, const ConvexPartsOptions& options)
{
  base::checked(options);
  if (geometry::hullSurface(mesh.vertices).triangles.empty())
    return {};
  const Eigen::Isometry3d T_frame_box = geometry::smallestBox(mesh.vertices).T_frame_box;
  mesh::TriangleMesh in_box{ mesh.vertices, {}, {}, {}, mesh.triangles };
  mesh::transform(T_frame_box.inverse(), &in_box);
  const Soup fine = soupOf(in_box);
  Eigen::AlignedBox3f all;
  for (const Eigen::Vector3f& vertex : in_box.vertices)
    all.extend(vertex);
  const float diagonal_m = all.diagonal().norm();
  const double tolerance_m =
      std::max(options.max_concavity_m, options.max_concavity_ratio * static_cast<double>(diagonal_m));
  const Soup coarse = fine.size() > MAX_SEARCH_TRIANGLES ? coarsened(fine, SEARCH_CELL_RATIO * diagonal_m) : fine;
  std::vector<Part> parts = cutApart(coarse, all, tolerance_m, options.max_parts);
  join(tolerance_m, &parts);
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.volume_m3 > b.volume_m3; });
  std::vector<mesh::TriangleMesh> result;
  for (const Part& part : parts)
  {
    const geometry::HullSurface hull = finalHull(fine, part, static_cast<std::size_t>(options.max_vertices));
    if (hull.triangles.empty())
      continue;
    mesh::TriangleMesh convex{ hull.vertices, {}, {}, {}, hull.triangles };
    mesh::transform(T_frame_box, &convex);
    result.push_back(std::move(convex));
  }
  return result;
}

}  // namespace object_modelling::object_properties
