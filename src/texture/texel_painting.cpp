#include "texel_painting.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "object_modelling/mesh/triangle_raster.h"

namespace object_modelling::texture
{
namespace
{
/// Views that see a corner of a triangle, with their weights at the three.
struct CornerWeights
{
  int view = -1;
  Eigen::Vector3f at_corners = Eigen::Vector3f::Zero();
};

std::vector<CornerWeights> cornerWeights(const VertexWeights& weights, const std::array<std::uint32_t, 3>& triangle)
{
  std::vector<CornerWeights> result;
  for (int corner = 0; corner < 3; ++corner)
    for (const VertexView& seen : weights[triangle[corner]])
    {
      auto at = std::find_if(result.begin(), result.end(),
                             [&](const CornerWeights& entry) { return entry.view == seen.view; });
      if (at == result.end())
        at = result.insert(result.end(), { seen.view, Eigen::Vector3f::Zero() });
      at->at_corners[corner] = seen.weight;
    }
  return result;
}

/// Colour at a point of a triangle. Shares beyond the triangle give the colour beside it, in its plane, with the
/// weights of its rim.
class Blend
{
public:
  Blend(const Paint& paint, const std::vector<ViewImage>& images, const std::vector<Eigen::Vector3f>& vertex_colors)
      : paint_(paint), images_(images), vertex_colors_(vertex_colors)
  {
  }

  Eigen::Vector3f at(std::size_t triangle, const std::vector<CornerWeights>& candidates,
                     const Eigen::Vector3f& point_shares) const
  {
    const Eigen::Vector3f shares = point_shares.cwiseMax(0) / point_shares.cwiseMax(0).sum();
    Eigen::Vector3f point = Eigen::Vector3f::Zero(), filled = Eigen::Vector3f::Zero();
    float seen_share = 0;  // at the border of the unseen the two run into each other
    for (int corner = 0; corner < 3; ++corner)
    {
      const std::uint32_t vertex = paint_.mesh.triangles[triangle][corner];
      point += point_shares[corner] * paint_.mesh.vertices[vertex];
      filled += shares[corner] * vertex_colors_[vertex];
      seen_share += paint_.weights[vertex].empty() ? 0 : shares[corner];
    }
    float best = 0;
    for (const CornerWeights& candidate : candidates)
      best = std::max(best, candidate.at_corners.dot(shares));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float total = 0;
    for (const CornerWeights& candidate : candidates)
    {
      const float weight = candidate.at_corners.dot(shares);
      if (!(weight > 0))
        continue;
      const float preferred = std::pow(weight / best, static_cast<float>(paint_.view_preference));
      const TextureView& view = paint_.views[candidate.view];
      sum += preferred *
             lightGain(view.light, triangle, shares).cwiseProduct(images_[candidate.view].at(colorPixel(view, point)));
      total += preferred;
    }
    return total > 0 ? Eigen::Vector3f(seen_share * (sum / total) + (1 - seen_share) * filled) : filled;
  }

private:
  Eigen::Vector3f lightGain(int light, std::size_t triangle, const Eigen::Vector3f& shares) const
  {
    Eigen::Vector3f gain = Eigen::Vector3f::Zero();
    for (int corner = 0; corner < 3; ++corner)
      gain += shares[corner] * paint_.exposure.ofLight(light, paint_.mesh.triangles[triangle][corner]);
    return gain;
  }

  const Paint& paint_;
  const std::vector<ViewImage>& images_;
  const std::vector<Eigen::Vector3f>& vertex_colors_;
};

}  // namespace

TexelOwners findOwners(const Atlas& atlas)
{
  TexelOwners owners;
  cv::Mat& owner = owners.triangle;
  owner = cv::Mat(atlas.size_px, CV_32SC1, cv::Scalar(-1));
  for (std::size_t t = 0; t < atlas.texels.size(); ++t)
    mesh::forEachPixelInside(atlas.texels[t], -mesh::ON_EDGE_SHARE, atlas.size_px,
                             [&](int u, int v, const Eigen::Vector3f&)
                             {
                               if (owner.at<int>(v, u) < 0)
                                 owner.at<int>(v, u) = static_cast<int>(t);
                             });
  for (std::size_t t = 0; t < atlas.texels.size(); ++t)  // slivers between the texels' centres
    for (const Eigen::Vector2f& corner : atlas.texels[t])
    {
      int& own = owner.at<int>(cvRound(corner.y()), cvRound(corner.x()));
      if (own < 0)
        own = static_cast<int>(t);
    }
  owners.inside = owner >= 0;
  for (int v = 0; v < owner.rows; ++v)
    for (int u = 0; u < owner.cols; ++u)
    {
      int& own = owner.at<int>(v, u);
      for (int k = 0; k < 8 && own < 0; ++k)
      {
        constexpr std::array<std::array<int, 2>, 8> AROUND{
          { { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 }, { 1, 1 }, { -1, 1 }, { 1, -1 }, { -1, -1 } }
        };
        const cv::Point beside(u + AROUND[k][0], v + AROUND[k][1]);
        if (cv::Rect({ 0, 0 }, owner.size()).contains(beside) && owners.inside.at<std::uint8_t>(beside))
          own = owner.at<int>(beside);
      }
    }
  return owners;
}

namespace
{
void dilate(const cv::Mat& inside, int padding_px, cv::Mat* texture_bgr)
{
  cv::Mat done = inside.clone();
  for (int ring = 0; ring < padding_px; ++ring)
  {
    const cv::Mat before = done.clone();
    for (int v = 0; v < done.rows; ++v)
      for (int u = 0; u < done.cols; ++u)
      {
        if (before.at<std::uint8_t>(v, u))
          continue;
        cv::Vec3f sum(0, 0, 0);
        float count = 0;
        for (int y = std::max(0, v - 1); y <= std::min(done.rows - 1, v + 1); ++y)
          for (int x = std::max(0, u - 1); x <= std::min(done.cols - 1, u + 1); ++x)
            if (before.at<std::uint8_t>(y, x))
            {
              sum += texture_bgr->at<cv::Vec3f>(y, x);
              ++count;
            }
        if (count == 0)
          continue;
        texture_bgr->at<cv::Vec3f>(v, u) = sum / count;
        done.at<std::uint8_t>(v, u) = 255;
      }
  }
}

}  // namespace

cv::Mat paintAtlas(const Paint& paint, const Atlas& atlas, const TexelOwners& owners,
                   const std::vector<ViewImage>& images, const std::vector<Eigen::Vector3f>& vertex_colors,
                   int padding_px)
{
  cv::Mat texture_bgr = cv::Mat::zeros(atlas.size_px, CV_32FC3);
  const cv::Mat& owner = owners.triangle;
  const Blend blend(paint, images, vertex_colors);
#pragma omp parallel for schedule(dynamic, 8)
  for (int v = 0; v < owner.rows; ++v)
  {
    int last = -1;
    std::vector<CornerWeights> candidates;
    for (int u = 0; u < owner.cols; ++u)
    {
      const int triangle = owner.at<int>(v, u);
      if (triangle < 0)
        continue;
      if (triangle != last)
        candidates = cornerWeights(paint.weights, paint.mesh.triangles[triangle]);
      last = triangle;
      const Eigen::Vector2f texel(static_cast<float>(u), static_cast<float>(v));
      const Eigen::Vector3f color = blend.at(triangle, candidates, mesh::sharesAt(atlas.texels[triangle], texel));
      texture_bgr.at<cv::Vec3f>(v, u) = { color[0], color[1], color[2] };
    }
  }
  dilate(owner >= 0, padding_px - 1, &texture_bgr);
  return texture_bgr;
}

cv::Mat seenTexels(const Paint& paint, const Atlas& atlas, const TexelOwners& owners)
{
  cv::Mat seen = cv::Mat::zeros(atlas.size_px, CV_8UC1);
  const cv::Mat& owner = owners.triangle;
  for (int v = 0; v < owner.rows; ++v)
    for (int u = 0; u < owner.cols; ++u)
    {
      if (!owners.inside.at<std::uint8_t>(v, u))
        continue;
      const int triangle = owner.at<int>(v, u);
      const Eigen::Vector3f shares =
          mesh::sharesAt(atlas.texels[triangle], { static_cast<float>(u), static_cast<float>(v) });
      for (int corner = 0; corner < 3; ++corner)
        if (shares[corner] > mesh::ON_EDGE_SHARE && !paint.weights[paint.mesh.triangles[triangle][corner]].empty())
          seen.at<std::uint8_t>(v, u) = 255;
    }
  return seen;
}

}  // namespace object_modelling::texture
