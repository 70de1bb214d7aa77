#include "mesh_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "object_modelling/mesh/mesh_topology.h"
#include "object_modelling/mesh/triangle_raster.h"

namespace object_modelling::texture
{
namespace
{
constexpr float BORDER_COST = 0.25f;  ///< per edge between directions, in cosines
constexpr int SMOOTHING_PASSES = 10;
constexpr int NORMAL_SMOOTHING_PASSES = 6;  ///< for the choice of directions, so that borders are not ragged
constexpr float MIN_CHART_COSINE = 0.35f;   ///< to the direction a triangle is projected along
constexpr std::size_t SMALL_CHART = 100;    ///< triangles; smaller ones join a neighbour that they lie flat with
constexpr int MERGING_PASSES = 4;

const std::array<Eigen::Vector3f, 6> DIRECTIONS{ Eigen::Vector3f(1, 0, 0),  Eigen::Vector3f(0, 1, 0),
                                                 Eigen::Vector3f(0, 0, 1),  Eigen::Vector3f(-1, 0, 0),
                                                 Eigen::Vector3f(0, -1, 0), Eigen::Vector3f(0, 0, -1) };

using Labels = std::vector<int>;

/// Connected triangles of one label; each group ascending, groups by their first triangle.
std::vector<std::vector<int>> connectedGroups(const mesh::TriangleNeighbors& neighbors, const Labels& labels,
                                              const std::vector<int>& triangles)
{
  std::vector<char> pending(labels.size(), 0);
  for (const int t : triangles)
    pending[t] = 1;
  std::vector<std::vector<int>> groups;
  for (const int seed : triangles)
  {
    if (!pending[seed])
      continue;
    std::vector<int> group{ seed };
    pending[seed] = 0;
    for (std::size_t next = 0; next < group.size(); ++next)
      for (const int neighbor : neighbors[group[next]])
        if (neighbor >= 0 && pending[neighbor] && labels[neighbor] == labels[seed])
        {
          pending[neighbor] = 0;
          group.push_back(neighbor);
        }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

std::vector<Eigen::Vector3f> smoothed(std::vector<Eigen::Vector3f> normals, const mesh::TriangleNeighbors& neighbors)
{
  std::vector<Eigen::Vector3f> next(normals.size());
  for (int pass = 0; pass < NORMAL_SMOOTHING_PASSES; ++pass)
  {
    for (std::size_t t = 0; t < normals.size(); ++t)
    {
      next[t] = normals[t];
      for (const int neighbor : neighbors[t])
        if (neighbor >= 0)
          next[t] += normals[neighbor];
      next[t] /= std::max(1e-6f, next[t].norm());
    }
    normals.swap(next);
  }
  return normals;
}

/// Iterated conditional modes on cosine to the direction plus the length of borders.
Labels labelDirections(const std::vector<Eigen::Vector3f>& normals, const mesh::TriangleNeighbors& neighbors)
{
  const std::vector<Eigen::Vector3f> smooth = smoothed(normals, neighbors);
  Labels labels(normals.size());
  for (int pass = 0; pass <= SMOOTHING_PASSES; ++pass)
    for (std::size_t t = 0; t < normals.size(); ++t)
    {
      float best = std::numeric_limits<float>::infinity();
      int label = 0;
      for (int d = 0; d < static_cast<int>(DIRECTIONS.size()); ++d)
      {
        const bool flat = normals[t].dot(DIRECTIONS[d]) >= MIN_CHART_COSINE;
        float cost = -smooth[t].dot(DIRECTIONS[d]) + (flat ? 0.f : 2.f);
        for (const int neighbor : neighbors[t])
          if (pass > 0 && neighbor >= 0 && labels[neighbor] != d)
            cost += BORDER_COST;
        if (cost < best)
        {
          best = cost;
          label = d;
        }
      }
      labels[t] = label;
    }
  return labels;
}

/// Gives small groups to the direction of a neighbour in which all of their triangles still lie flat.
void mergeSmallGroups(const std::vector<Eigen::Vector3f>& normals, const mesh::TriangleNeighbors& neighbors,
                      const std::vector<int>& all, Labels* labels)
{
  for (int pass = 0; pass < MERGING_PASSES; ++pass)
    for (const std::vector<int>& group : connectedGroups(neighbors, *labels, all))
    {
      if (group.size() >= SMALL_CHART)
        continue;
      std::array<int, DIRECTIONS.size()> shared_edges{};
      for (const int t : group)
        for (const int neighbor : neighbors[t])
          if (neighbor >= 0 && (*labels)[neighbor] != (*labels)[t])
            ++shared_edges[(*labels)[neighbor]];
      int best = -1;
      for (int d = 0; d < static_cast<int>(DIRECTIONS.size()); ++d)
      {
        const bool flat = std::all_of(group.begin(), group.end(),
                                      [&](int t) { return normals[t].dot(DIRECTIONS[d]) >= MIN_CHART_COSINE; });
        if (flat && shared_edges[d] > 0 && (best < 0 || shared_edges[d] > shared_edges[best]))
          best = d;
      }
      if (best >= 0)
        for (const int t : group)
          (*labels)[t] = best;
    }
}

/// Projection of triangles along their mean normal, turned so that they fill their rectangle best.
class Flattening
{
public:
  Flattening(const mesh::TriangleMesh& mesh, const std::vector<int>& triangles) : mesh_(mesh)
  {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    for (const int t : triangles)
    {
      const auto& [a, b, c] = mesh.triangles[t];
      normal += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    }
    normal_ = normal.norm() > 0 ? Eigen::Vector3f(normal.normalized()) : Eigen::Vector3f(Eigen::Vector3f::UnitZ());
    right_ = normal_.unitOrthogonal();
    down_ = right_.cross(normal_);  // seen from outside, so that nothing is mirrored
    std::vector<cv::Point2f> points;
    for (const int t : triangles)
      for (const Eigen::Vector2f& p : corners_m(t))
        points.emplace_back(p.x(), p.y());
    const auto angle_rad = static_cast<float>(cv::minAreaRect(points).angle * CV_PI / 180);
    const Eigen::Vector3f right = std::cos(angle_rad) * right_ + std::sin(angle_rad) * down_;
    down_ = -std::sin(angle_rad) * right_ + std::cos(angle_rad) * down_;
    right_ = right;
  }

  const Eigen::Vector3f& normal() const { return normal_; }
  std::array<Eigen::Vector2f, 3> corners_m(int triangle) const
  {
    std::array<Eigen::Vector2f, 3> corners;
    for (int i = 0; i < 3; ++i)
    {
      const Eigen::Vector3f& p = mesh_.vertices[mesh_.triangles[triangle][i]];
      corners[i] = { right_.dot(p), down_.dot(p) };
    }
    return corners;
  }

private:
  const mesh::TriangleMesh& mesh_;
  Eigen::Vector3f normal_, right_, down_;
};

/// Lays out what fits of a group; the rest comes back.
Chart layOut(const mesh::TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& normals, const std::vector<int>& group,
             double raster_m, std::vector<int>* rest)
{
  const Flattening flattening(mesh, group);
  std::vector<std::array<Eigen::Vector2f, 3>> corners;
  Eigen::AlignedBox2f box;
  for (const int t : group)
  {
    corners.push_back(flattening.corners_m(t));
    for (const Eigen::Vector2f& corner : corners.back())
      box.extend(corner);
  }
  const auto scale = static_cast<float>(1 / raster_m);
  const Eigen::Vector2f extent = box.sizes() * scale;
  cv::Mat taken = cv::Mat::zeros(static_cast<int>(extent.y()) + 2, static_cast<int>(extent.x()) + 2, CV_8UC1);
  Chart chart;
  for (std::size_t i = 0; i < group.size(); ++i)
  {
    std::array<Eigen::Vector2f, 3> on_raster;
    for (int k = 0; k < 3; ++k)
    {
      corners[i][k] -= box.min();
      on_raster[k] = corners[i][k] * scale;
    }
    const bool alone = group.size() == 1;
    bool fits = alone || normals[group[i]].dot(flattening.normal()) >= 0.5f * MIN_CHART_COSINE;
    if (fits && !alone)
      mesh::forEachPixelInside(on_raster, mesh::ON_EDGE_SHARE, taken.size(),
                               [&](int u, int v, const Eigen::Vector3f&)
                               { fits = fits && taken.at<std::uint8_t>(v, u) == 0; });
    if (!fits)
    {
      rest->push_back(group[i]);
      continue;
    }
    mesh::forEachPixelInside(on_raster, mesh::ON_EDGE_SHARE, taken.size(),
                             [&](int u, int v, const Eigen::Vector3f&) { taken.at<std::uint8_t>(v, u) = 1; });
    chart.triangles.push_back(group[i]);
    chart.corners_m.push_back(corners[i]);
  }
  chart.size_m = box.sizes();
  return chart;
}
}  // namespace

std::vector<Chart> makeCharts(const mesh::TriangleMesh& mesh, double raster_m)
{
  std::vector<Eigen::Vector3f> normals(mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t)
    normals[t] = mesh::triangleNormal(mesh, t);
  const mesh::TriangleNeighbors neighbors = mesh::triangleNeighbors(mesh);
  std::vector<int> pending(mesh.triangles.size());
  std::iota(pending.begin(), pending.end(), 0);
  Labels labels = labelDirections(normals, neighbors);
  mergeSmallGroups(normals, neighbors, pending, &labels);

  std::vector<Chart> charts;
  while (!pending.empty())
  {
    std::vector<int> rest;
    for (const std::vector<int>& group : connectedGroups(neighbors, labels, pending))
    {
      const std::size_t before = rest.size();
      Chart chart = layOut(mesh, normals, group, raster_m, &rest);
      if (chart.triangles.empty())  // folded up in itself: one triangle is always flat
      {
        rest.resize(before);
        chart = layOut(mesh, normals, { group.front() }, raster_m, &rest);
        rest.insert(rest.end(), group.begin() + 1, group.end());
      }
      charts.push_back(std::move(chart));
    }
    std::sort(rest.begin(), rest.end());
    pending = std::move(rest);
  }
  return charts;
}

}  // namespace object_modelling::texture
