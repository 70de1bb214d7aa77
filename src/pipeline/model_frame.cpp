#include "model_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace object_modelling::pipeline
{
namespace
{
constexpr double MAX_FOOT_GAP_M = 0.02;  // a larger gap means that the plane is not what the object stands on
constexpr int DIAMETER_DIRECTIONS = 512;

/// The box turned by multiples of 90 degrees so that its z axis is the one nearest to `up`, and x the longer of the
/// others.
geometry::OrientedBox turnedUp(const geometry::OrientedBox& box, const Eigen::Vector3d& up)
{
  const Eigen::Matrix3d axes = box.T_frame_box.linear();
  int vertical = 0;
  (axes.transpose() * up).cwiseAbs().maxCoeff(&vertical);
  int longer = (vertical + 1) % 3;
  int shorter = (vertical + 2) % 3;
  if (box.size_m[longer] < box.size_m[shorter])
    std::swap(longer, shorter);
  const Eigen::Vector3d z = axes.col(vertical) * (axes.col(vertical).dot(up) < 0 ? -1.0 : 1.0);
  const Eigen::Vector3d x = axes.col(longer);
  geometry::OrientedBox turned = box;
  turned.T_frame_box.linear().col(0) = x;
  turned.T_frame_box.linear().col(1) = z.cross(x);
  turned.T_frame_box.linear().col(2) = z;
  turned.size_m = { box.size_m[longer], box.size_m[shorter], box.size_m[vertical] };
  return turned;
}
}  // namespace

geometry::OrientedBox objectBox(const std::vector<Eigen::Vector3f>& points_reference,
                                const std::optional<geometry::Plane>& support_plane_reference)
{
  // In the optical frame of the first camera -y is nearest to up for a camera that is held upright.
  if (!support_plane_reference)
    return turnedUp(geometry::smallestBox(points_reference), -Eigen::Vector3d::UnitY());
  geometry::OrientedBox box = geometry::boxAlong(support_plane_reference->normal, points_reference);
  const Eigen::Vector3d bottom = box.T_frame_box * Eigen::Vector3d(0, 0, -box.size_m.z() / 2);
  const double gap_m = support_plane_reference->signedDistance_m(bottom);
  // A flat object that noise has put wholly below the plane keeps its own height.
  if (std::abs(gap_m) <= MAX_FOOT_GAP_M && box.size_m.z() + gap_m > 0)
  {
    box.size_m.z() += gap_m;
    box.T_frame_box.translation() -= support_plane_reference->normal * gap_m / 2;
  }
  return box;
}

double diameter_m(const std::vector<Eigen::Vector3f>& points)
{
  std::vector<Eigen::Vector3f> extremes;
  for (int i = 0; i < DIAMETER_DIRECTIONS && !points.empty(); ++i)
  {
    // Fibonacci spiral over the sphere
    const double z = 1 - (2 * i + 1.0) / DIAMETER_DIRECTIONS;
    const double turn_rad = i * M_PI * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3f direction(static_cast<float>(r * std::cos(turn_rad)),
                                    static_cast<float>(r * std::sin(turn_rad)), static_cast<float>(z));
    extremes.push_back(*std::max_element(points.begin(), points.end(),
                                         [&direction](const Eigen::Vector3f& a, const Eigen::Vector3f& b)
                                         { return a.dot(direction) < b.dot(direction); }));
  }
  float largest = 0;
  for (const Eigen::Vector3f& a : extremes)
    for (const Eigen::Vector3f& b : extremes)
      largest = std::max(largest, (a - b).squaredNorm());
  return std::sqrt(static_cast<double>(largest));
}

}  // namespace object_modelling::pipeline
