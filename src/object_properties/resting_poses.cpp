#include "object_modelling/object_properties/resting_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "hull_regions.h"
#include "object_modelling/base/disjoint_sets.h"
#include "object_modelling/base/options.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr double DEG = M_PI / 180;

std::vector<std::size_t> byHeight(const std::vector<HullRegion>& regions)
{
  std::vector<std::size_t> order(regions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return regions[a].height_m < regions[b].height_m; });
  return order;
}

/// The lower region that an object lying on `region` rolls to; -1: it stays.
int rollsTo(const std::vector<HullRegion>& regions, const HullRegion& region, double max_barrier_m)
{
  int next = -1, lowest = -1;
  double largest = region.stable ? -max_barrier_m : -std::numeric_limits<double>::infinity();
  for (const RegionBorder& border : region.borders)
  {
    const HullRegion& other = regions[border.other];
    if (!(other.height_m < region.height_m))
      continue;
    if (lowest < 0 || other.height_m < regions[static_cast<std::size_t>(lowest)].height_m)
      lowest = static_cast<int>(border.other);
    // A stable face is left over its lowest edge, an unstable one over that which the centre of mass is furthest
    // beyond.
    const double ease_m = region.stable ? region.height_m - border.edge_distance_m : border.overhang_m;
    const bool rolls_back = region.stable && border.edge_distance_m - other.height_m <= max_barrier_m;
    if (ease_m >= largest && !rolls_back)
    {
      largest = ease_m;
      next = static_cast<int>(border.other);
    }
  }
  return next >= 0 || region.stable ? next : lowest;
}

/// A pose, or several between which the object rolls freely.
struct Family
{
  std::vector<std::size_t> regions;  ///< the most probable first
  double probability = 0;
  int recorded = -1;
};

std::vector<Family> familiesOf(const std::vector<HullRegion>& regions, double max_barrier_ratio)
{
  std::vector<std::size_t> sink(regions.size());
  std::vector<double> probability(regions.size(), 0);
  for (const std::size_t i : byHeight(regions))
  {
    const int next = rollsTo(regions, regions[i], max_barrier_ratio * regions[i].height_m);
    sink[i] = next < 0 ? i : sink[static_cast<std::size_t>(next)];
    probability[sink[i]] += regions[i].solid_angle_ratio;
  }
  base::DisjointSets sets(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i)
    for (const RegionBorder& border : regions[i].borders)
    {
      // Over this edge the way leads down to both, and back.
      const std::size_t one = sink[i], other = sink[border.other];
      const double lower_m = std::min(regions[one].height_m, regions[other].height_m);
      if (border.edge_distance_m - lower_m <= max_barrier_ratio * lower_m)
        sets.unite(static_cast<std::uint32_t>(one), static_cast<std::uint32_t>(other));
    }
  std::vector<Family> of_root(regions.size());
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (sink[i] == i)
    {
      Family& family = of_root[sets.find(static_cast<std::uint32_t>(i))];
      family.regions.push_back(i);
      family.probability += probability[i];
    }
  std::vector<Family> families;
  for (Family& family : of_root)
    if (!family.regions.empty())
    {
      std::stable_sort(family.regions.begin(), family.regions.end(),
                       [&](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });
      families.push_back(std::move(family));
    }
  return families;
}

/// The family that a recorded pose is one of; -1: none is as near as that.
int familyOf(const Eigen::Isometry3d& T_support_model, const std::vector<Family>& families,
             const std::vector<HullRegion>& regions, double max_deg)
{
  const Eigen::Vector3d down = -T_support_model.linear().row(2).transpose();
  double largest = std::cos(max_deg * DEG);
  int nearest = -1;
  for (std::size_t f = 0; f < families.size(); ++f)
    for (const std::size_t r : families[f].regions)
      if (regions[r].normal.dot(down) > largest)
      {
        largest = regions[r].normal.dot(down);
        nearest = static_cast<int>(f);
      }
  return nearest;
}

/// Turned no further than the face asks for; the origin of the model stays above that of the plane.
Eigen::Isometry3d restingOn(const HullRegion& region, const Eigen::Vector3d& center_of_mass_m)
{
  Eigen::Isometry3d T_support_model = Eigen::Isometry3d::Identity();
  T_support_model.linear() = geometry::rotationBetween(region.normal, -Eigen::Vector3d::UnitZ());
  T_support_model.translation().z() = region.height_m + region.normal.dot(center_of_mass_m);
  return T_support_model;
}

/// Probabilities that add up to 1, the most probable pose first.
void normalize(std::vector<RestingPose>* poses)
{
  double sum = 0;
  for (const RestingPose& pose : *poses)
    sum += pose.probability;
  for (RestingPose& pose : *poses)
    pose.probability = sum > 0 ? pose.probability / sum : 1.0 / static_cast<double>(poses->size());
  // Of those that are equally probable but for rounding the upright one first.
  const auto before = [](const RestingPose& a, const RestingPose& b)
  {
    const long share_a = std::lround(1000 * a.probability), share_b = std::lround(1000 * b.probability);
    const long up_a = std::lround(1000 * a.T_support_model.linear()(2, 2)),
               up_b = std::lround(1000 * b.T_support_model.linear()(2, 2));
    return share_a != share_b ? share_a > share_b : up_a > up_b;
  };
  std::stable_sort(poses->begin(), poses->end(), before);
}
}  // namespace

std::vector<std::string> RestingPoseOptions::violations() const
{
  base::OptionsCheck check("resting_poses");
  check.inRange("max_coplanar_deg", max_coplanar_deg, 0.0, 20.0);
  check.inRange("max_barrier_ratio", max_barrier_ratio, 0.0, 1.0);
  check.inRange("max_seen_deg", max_seen_deg, 0.0, 90.0);
  check.inRange("min_probability", min_probability, 0.0, 1.0);
  return check.violations();
}

std::vector<RestingPose> restingPoses(const std::vector<Eigen::Vector3f>& points,
                                      const Eigen::Vector3d& center_of_mass_m,
                                      const std::vector<Eigen::Isometry3d>& recorded_T_support_model,
                                      const RestingPoseOptions& options)
{
  base::checked(options);
  const std::vector<HullRegion> regions = hullRegions(points, center_of_mass_m, options.max_coplanar_deg * DEG);
  std::vector<Family> families = familiesOf(regions, options.max_barrier_ratio);
  std::vector<RestingPose> poses;
  for (std::size_t i = 0; i < recorded_T_support_model.size(); ++i)
  {
    const int family = familyOf(recorded_T_support_model[i], families, regions, options.max_seen_deg);
    if (family < 0)
      poses.push_back({ recorded_T_support_model[i], 0, true });
    else if (families[static_cast<std::size_t>(family)].recorded < 0)
      families[static_cast<std::size_t>(family)].recorded = static_cast<int>(i);
  }
  for (const Family& family : families)
  {
    const bool seen = family.recorded >= 0;
    if (seen || family.probability >= options.min_probability)
      poses.push_back({ seen ? recorded_T_support_model[static_cast<std::size_t>(family.recorded)]
                             : restingOn(regions[family.regions.front()], center_of_mass_m),
                        family.probability, seen });
  }
  normalize(&poses);
  return poses;
}

}  // namespace object_modelling::object_properties
