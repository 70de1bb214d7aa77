#include "object_modelling/object_properties/object_properties.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <opencv2/imgproc.hpp>

#include "object_modelling/base/options.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr double FOOT_HEIGHT_M = 0.005;  // what is that near to the support, or a share of the height, is the bottom
constexpr double FOOT_HEIGHT_RATIO = 0.05;
constexpr double MIN_SEEN_BOTTOM_RATIO = 0.4;  // of the area on which the object stands

struct Triangle
{
  Eigen::Vector3d center, area_normal;  ///< the normal as long as the area
  bool seen = false;
};

Triangle triangleOf(const mesh::TriangleMesh& mesh, std::size_t index)
{
  const auto& [a, b, c] = mesh.triangles[index];
  const Eigen::Vector3d p = mesh.vertices[a].cast<double>(), q = mesh.vertices[b].cast<double>(),
                        r = mesh.vertices[c].cast<double>();
  return { (p + q + r) / 3, (q - p).cross(r - p) / 2,
           mesh.seen.empty() || (mesh.seen[a] > 0 && mesh.seen[b] > 0 && mesh.seen[c] > 0) };
}

/// Of the outline of what is near to the support, seen from above.
double footprint_m2(const mesh::TriangleMesh& mesh, const Eigen::Isometry3d& T_support_model, double height_m)
{
  std::vector<cv::Point2f> points, outline;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
  {
    const Eigen::Vector3d p = T_support_model * vertex.cast<double>();
    if (p.z() < height_m)
      points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  if (points.size() < 3)
    return 0;
  cv::convexHull(points, outline);
  return cv::contourArea(outline);
}

std::string symmetryText(const ObjectProperties& properties, Symmetry::Of of)
{
  std::string text;
  for (const Symmetry& symmetry : properties.symmetries)
    if (symmetry.of == of)
      text += (text.empty() ? "" : ", ") +
              (symmetry.continuous() ? std::string("round") : std::to_string(symmetry.order) + "-fold");
  return text.empty() ? "none" : text;
}

/// The bottom by itself: where the mesh is open there, it is no share of the mesh's surface.
std::string unseenText(const Unseen& unseen, bool closed)
{
  const std::string bottom = closed ? "; the bottom was not seen" : "; the bottom was not seen, and may be open";
  return std::to_string(std::lround(100 * unseen.ratio)) + " % of the mesh unseen" + (unseen.bottom ? bottom : "");
}
}  // namespace

std::vector<std::string> PropertyOptions::violations() const
{
  base::OptionsCheck check("object_properties");
  check.include(mass.violations());
  check.include(resting_poses.violations());
  check.include(symmetry.violations());
  check.include(convex_parts.violations());
  return check.violations();
}

Unseen unseenOf(const mesh::TriangleMesh& mesh, const Eigen::Isometry3d& T_support_model)
{
  double top_m = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    top_m = std::max(top_m, (T_support_model * vertex.cast<double>()).z());
  const double foot_m = std::max(FOOT_HEIGHT_M, FOOT_HEIGHT_RATIO * top_m);
  double area_m2 = 0, unseen_m2 = 0, seen_bottom_m2 = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    const Triangle triangle = triangleOf(mesh, t);
    area_m2 += triangle.area_normal.norm();
    unseen_m2 += triangle.seen ? 0 : triangle.area_normal.norm();
    const double downward_m2 = -(T_support_model.linear() * triangle.area_normal).z();
    if (triangle.seen && downward_m2 > 0.5 * triangle.area_normal.norm() &&
        (T_support_model * triangle.center).z() < foot_m)
      seen_bottom_m2 += downward_m2;
  }
  return { area_m2 > 0 ? unseen_m2 / area_m2 : 0,
           seen_bottom_m2 < MIN_SEEN_BOTTOM_RATIO * footprint_m2(mesh, T_support_model, foot_m) };
}

ObjectProperties propertiesOf(const mesh::TriangleMesh& mesh,
                              const std::vector<Eigen::Isometry3d>& recorded_T_support_model,
                              const PropertyOptions& options, base::JobControl& control)
{
  base::checked(options);
  constexpr char STAGE[] = "properties";
  ObjectProperties properties;
  control.report(STAGE, 0, 3);
  properties.mass = massProperties(mesh, options.mass);
  properties.resting_poses =
      restingPoses(mesh.vertices, properties.mass.center_of_mass_m, recorded_T_support_model, options.resting_poses);
  control.report(STAGE, 1, 3);
  properties.symmetries = findSymmetries(mesh, options.symmetry);
  control.report(STAGE, 2, 3);
  properties.collision_parts = convexParts(mesh, options.convex_parts);
  if (!mesh.seen.empty() && !properties.resting_poses.empty())
    properties.unseen =
        unseenOf(mesh, recorded_T_support_model.empty() ? properties.resting_poses.front().T_support_model
                                                        : recorded_T_support_model.front());
  control.report(STAGE, 3, 3);
  return properties;
}

std::string summaryText(const ObjectProperties& properties, std::size_t part_count)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << "volume " << properties.mass.volume_m3 * 1e6 << " ml"
       << (properties.mass.of == Solid::MESH   ? ""
           : properties.mass.of == Solid::HULL ? " (of the hull)"
                                               : " (holes closed)")
       << ", symmetries: " << symmetryText(properties, Symmetry::Of::SHAPE)
       << " (with texture: " << symmetryText(properties, Symmetry::Of::TEXTURE) << "), resting poses:";
  std::size_t seen = 0;
  for (const RestingPose& pose : properties.resting_poses)
  {
    text << " " << 100 * pose.probability << " %";
    seen += pose.seen ? 1 : 0;
  }
  text << " (" << seen << " recorded), " << part_count << " convex part(s)";
  if (properties.unseen)
    text << ", " << unseenText(*properties.unseen, properties.mass.closed);
  return text.str();
}

}  // namespace object_modelling::object_properties
