#include "self_comparison.h"

#include <algorithm>
#include <cmath>

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/geometry/so3.h"
#include "object_modelling/mesh/mesh_topology.h"
#include "object_modelling/mesh/surface_sampling.h"

namespace object_modelling::object_properties
{
namespace
{
constexpr std::size_t COMPARED_SAMPLES = 8000;
constexpr std::size_t ROUGH_STEP = 20;  // every so many samples are probed in a search
constexpr std::size_t EXACT_STEP = 8;
constexpr int ICP_STEPS = 8;
constexpr double MAX_PARTNER_RATIO = 0.15;  // of the diameter
constexpr std::size_t COLOR_NEIGHBORS = 5;
constexpr float MAX_CHANNEL_DIFFERENCE = 80;  // what a highlight counts at most
constexpr int DIAMETER_DIRECTIONS = 200;

Eigen::Vector3f direction(int i, int count)
{
  // Fibonacci spiral over the sphere
  const double z = 1 - (2 * i + 1.0) / count, turn_rad = i * M_PI * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
  return Eigen::Vector3d(r * std::cos(turn_rad), r * std::sin(turn_rad), z).cast<float>();
}
}  // namespace

Eigen::Isometry3d Axis::turn(double angle_rad) const
{
  const Eigen::AngleAxisd rotation(angle_rad, direction);
  return Eigen::Translation3d(point_m) * rotation * Eigen::Translation3d(-point_m);
}

SelfComparison::SelfComparison(const mesh::TriangleMesh& mesh) : reference_(mesh)
{
  for (const mesh::SurfaceSample& sample : mesh::sampleEvenly(mesh, COMPARED_SAMPLES))
  {
    points_.emplace_back(mesh::pointAt(mesh, sample).cast<float>());
    normals_.push_back(mesh::triangleNormal(mesh, sample.triangle));
    Eigen::Vector3f color = Eigen::Vector3f::Zero();
    bool seen = true;
    for (int k = 0; k < 3; ++k)
    {
      const std::uint32_t vertex = mesh.triangles[sample.triangle][static_cast<std::size_t>(k)];
      if (!mesh.colors.empty())
        color += static_cast<float>(sample.shares[k]) * mesh.colors[vertex].cast<float>();
      seen = seen && (mesh.seen.empty() || mesh.seen[vertex] > 0);
    }
    seen_.push_back(seen ? 1 : 0);
    if (!mesh.colors.empty())
      colors_.push_back(color);
  }
  index_ = std::make_unique<geometry::PointIndex>(points_);
  spacing_m_ = std::sqrt(mesh::surfaceArea_m2(mesh) / static_cast<double>(points_.size()));
  describe();
}

void SelfComparison::describe()
{
  double count = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (seen_[i] > 0)
    {
      centroid_ += points_[i].cast<double>();
      ++count;
    }
  centroid_ /= std::max(count, 1.0);
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (seen_[i] > 0)
    {
      const Eigen::Vector3d p = points_[i].cast<double>() - centroid_;
      second += p * p.transpose() / count;
    }
  const geometry::EigenSystem<3> moments = geometry::eigenSystem(second);
  moments_m2_ = moments.values;
  moment_axes_ = moments.vectors;
  for (int i = 0; i < DIAMETER_DIRECTIONS; ++i)
  {
    const Eigen::Vector3f along = direction(i, DIAMETER_DIRECTIONS);
    float low = 0, high = 0;
    for (const Eigen::Vector3f& point : points_)
    {
      const float at = along.dot(point - points_.front());
      low = std::min(low, at);
      high = std::max(high, at);
    }
    diameter_m_ = std::max(diameter_m_, static_cast<double>(high - low));
  }
}

SelfDistance SelfComparison::summary(std::vector<double> distances_m, std::size_t probed) const
{
  SelfDistance distance;
  double sum = 0;
  for (const double d : distances_m)
    sum += d * d;
  distance.counted_ratio =
      static_cast<double>(distances_m.size()) / static_cast<double>(std::max<std::size_t>(probed, 1));
  distance.rms_m = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(distances_m.size(), 1)));
  distance.quantile_95_m = base::quantile(std::move(distances_m), 0.95);
  return distance;
}

SelfDistance SelfComparison::roughDistance(const Eigen::Isometry3d& T) const
{
  const Eigen::Isometry3f turn = T.cast<float>();
  std::vector<double> distances_m;
  std::size_t probed = 0;
  for (std::size_t i = 0; i < points_.size(); i += ROUGH_STEP)
  {
    ++probed;
    if (seen_[i] == 0)
      continue;
    const Eigen::Vector3f p = turn * points_[i];
    const std::uint32_t nearest = index_->nearest(p).index;
    if (seen_[nearest] == 0)
      continue;
    // To the tangent plane, and beyond the gap between samples along it.
    const Eigen::Vector3f offset = p - points_[nearest];
    const double across = normals_[nearest].dot(offset);
    const double along = std::sqrt(std::max(0.0, offset.squaredNorm() - across * across));
    distances_m.push_back(std::hypot(across, std::max(0.0, along - spacing_m_)));
  }
  return summary(std::move(distances_m), probed);
}

SelfDistance SelfComparison::distance(const Eigen::Isometry3d& T) const
{
  std::vector<double> distances_m;
  std::size_t probed = 0;
  for (std::size_t i = 0; i < points_.size(); i += EXACT_STEP)
  {
    ++probed;
    if (seen_[i] == 0)
      continue;
    const Eigen::Vector3d p = T * points_[i].cast<double>();
    if (seen_[index_->nearest(p.cast<float>()).index] > 0)
      distances_m.push_back(reference_.distance_m(p));
  }
  return summary(std::move(distances_m), probed);
}

Axis SelfComparison::refined(const Axis& axis, double angle_rad) const
{
  Eigen::Isometry3d T = axis.turn(angle_rad);
  for (int step = 0; step < ICP_STEPS; ++step)
  {
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < points_.size(); i += ROUGH_STEP)
    {
      const Eigen::Vector3d p = T * points_[i].cast<double>();
      const geometry::PointIndex::Neighbor nearest = index_->nearest(p.cast<float>());
      const Eigen::Vector3d n = normals_[nearest.index].cast<double>();
      const bool far = nearest.squared_distance > std::pow(MAX_PARTNER_RATIO * diameter_m_, 2);
      if (far || seen_[i] == 0 || seen_[nearest.index] == 0 || n.dot(T.linear() * normals_[i].cast<double>()) < 0.5)
        continue;
      Eigen::Matrix<double, 6, 1> jacobian;
      jacobian << (p - centroid_).cross(n) / diameter_m_, n;  // about the centroid; the turn in diameters
      A += jacobian * jacobian.transpose();
      b -= jacobian * n.dot(p - points_[nearest.index].cast<double>());
    }
    // Where the surface slides on itself nothing holds it: it stays.
    A.diagonal().array() += 1e-3 * A.trace() / 6 + 1e-12;
    const Eigen::Matrix<double, 6, 1> xi = geometry::solveSymmetric(A, b);
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = geometry::rotationFromVector(xi.head<3>() / diameter_m_);
    motion.translation() = centroid_ - motion.linear() * centroid_ + xi.tail<3>();
    T = motion * T;
  }
  Axis result;
  const Eigen::AngleAxisd turned(T.linear());
  result.direction = turned.axis() * (turned.axis().dot(axis.direction) < 0 ? -1.0 : 1.0);
  const Eigen::Matrix3d moved = Eigen::Matrix3d::Identity() - T.linear();
  // The fixed point nearest to the centroid; along the axis any will do.
  const Eigen::Matrix3d across = moved + result.direction * result.direction.transpose();
  Eigen::Vector3d t = T.translation() - moved * centroid_;
  t -= result.direction * result.direction.dot(t);
  result.point_m = centroid_ + across.inverse() * t;
  return result;
}

double SelfComparison::colorDifference(const Eigen::Isometry3d& T) const
{
  std::vector<std::size_t> probes;
  std::vector<std::vector<geometry::PointIndex::Neighbor>> partners;
  Eigen::Vector3f light = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < points_.size(); i += EXACT_STEP)
  {
    std::vector<geometry::PointIndex::Neighbor> near;
    index_->nearest(T.cast<float>() * points_[i], COLOR_NEIGHBORS, &near);
    if (seen_[i] == 0 || seen_[near.front().index] == 0)
      continue;
    light += colors_[near.front().index] - colors_[i];
    probes.push_back(i);
    partners.push_back(std::move(near));
  }
  light /= static_cast<float>(std::max<std::size_t>(probes.size(), 1));
  double sum = 0;
  for (std::size_t k = 0; k < probes.size(); ++k)
  {
    float least = MAX_CHANNEL_DIFFERENCE;
    for (const geometry::PointIndex::Neighbor& partner : partners[k])
      least = std::min(least, (colors_[partner.index] - colors_[probes[k]] - light).cwiseAbs().mean());
    sum += static_cast<double>(least * least);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(probes.size(), 1)));
}

}  // namespace object_modelling::object_properties
