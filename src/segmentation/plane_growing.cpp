#include "plane_growing.h"

#include <algorithm>
#include <cmath>

#include "noise_table.h"

namespace object_modelling::segmentation
{
namespace
{
constexpr int CELL_PX = 8;
constexpr float ROUGH_NORMAL_COS = 0.766F;  // 40 deg
constexpr std::int16_t NO_PLANE = -1;

struct Seed
{
  double mean_square = 0;
  int u = 0, v = 0;
  PlaneMoments moments;
};

class PlaneGrower
{
public:
  PlaneGrower(const WorkingImage& image, const PlaneGrowingOptions& options)
      : image_(image),
        noise_(NoiseTable::of(image.frame.noise_model)),
        options_(options),
        cos_angle_(static_cast<float>(std::cos(options.angle_rad))),
        width_(image.frame.depth_m.cols),
        height_(image.frame.depth_m.rows),
        labels_(height_, width_, CV_16SC1, cv::Scalar(NO_PLANE))
  {
  }

  GrownPlanes grow()
  {
    for (const Seed& seed : findSeeds())
      growFrom(seed);
    joinCoplanar();
    GrownPlanes result = sorted();
    for (std::size_t i = 0; i < result.planes.size(); ++i)
      extend(static_cast<std::int16_t>(i), &result.planes[i]);
    planes_ = std::move(result.planes);
    joinCoplanar();
    result = sorted();
    for (std::size_t i = 0; i < result.planes.size(); ++i)
      result.planes[i].noise_scale = noiseScale(static_cast<std::int16_t>(i), result.planes[i].plane);
    return result;
  }

private:
  bool hasNormal(int u, int v) const { return std::isfinite(image_.normals.at<cv::Vec3f>(v, u)[0]); }
  Eigen::Map<const Eigen::Vector3f> normal(int u, int v) const
  {
    return Eigen::Map<const Eigen::Vector3f>(image_.normals.at<cv::Vec3f>(v, u).val);
  }
  /// Standard deviation of the point along its normal: noise and distortion.
  float sigmaAlongNormal_m(const Eigen::Vector3f& p, const Eigen::Vector3f& n) const
  {
    const float noise_m = noise_->sigmaAlong_m(n, p);
    const float distortion_m = static_cast<float>(options_.distortion_ratio) * std::abs(n.dot(p));
    return std::sqrt(noise_m * noise_m + distortion_m * distortion_m);
  }

  std::vector<Seed> findSeeds() const
  {
    std::vector<Seed> seeds;
    for (int v = 0; v + CELL_PX <= height_; v += CELL_PX)
      for (int u = 0; u + CELL_PX <= width_; u += CELL_PX)
      {
        Seed seed;
        seed.u = u;
        seed.v = v;
        for (int y = v; y < v + CELL_PX; ++y)
          for (int x = u; x < u + CELL_PX; ++x)
            if (hasNormal(x, y))
            {
              const Eigen::Vector3f p = image_.frame.point(x, y);
              const double sigma_m = sigmaAlongNormal_m(p, normal(x, y));
              seed.moments.add(p.cast<double>(), 1 / (sigma_m * sigma_m));
            }
        geometry::Plane plane;
        if (seed.moments.count < CELL_PX * CELL_PX * 3 / 4 || !seed.moments.fit(Eigen::Vector3d::Zero(), &plane))
          continue;
        seed.mean_square = seed.moments.meanSquare(plane);
        if (seed.mean_square < 2)
          seeds.push_back(seed);
      }
    std::stable_sort(seeds.begin(), seeds.end(),
                     [](const Seed& a, const Seed& b) { return a.mean_square < b.mean_square; });
    return seeds;
  }

  /// The region that is growing.
  struct Region
  {
    std::int16_t label;
    Eigen::Vector3f n;
    float offset_m;
    float min_normal_cos;
    PlaneMoments* moments;
    void setPlane(const geometry::Plane& plane)
    {
      n = plane.normal.cast<float>();
      offset_m = static_cast<float>(plane.offset_m);
    }
  };

  /// Puts the pixel into the region if it fits the region's plane.
  void tryAdd(int u, int v, const Region& region)
  {
    std::int16_t& pixel_label = labels_.at<std::int16_t>(v, u);
    if (pixel_label != NO_PLANE || !hasNormal(u, v) || !(normal(u, v).dot(region.n) >= region.min_normal_cos))
      return;
    const Eigen::Vector3f p = image_.frame.point(u, v);
    const float sigma_m = sigmaAlongNormal_m(p, region.n);
    if (!(std::abs(region.n.dot(p) + region.offset_m) <= static_cast<float>(options_.distance_sigmas) * sigma_m))
      return;
    pixel_label = region.label;
    region.moments->add(p.cast<double>(), 1.0 / (static_cast<double>(sigma_m) * sigma_m));
    queue_.push_back(v * width_ + u);
  }

  void tryNeighbors(int index, const Region& region)
  {
    const int u = index % width_, v = index / width_;
    if (u > 0)
      tryAdd(u - 1, v, region);
    if (u + 1 < width_)
      tryAdd(u + 1, v, region);
    if (v > 0)
      tryAdd(u, v - 1, region);
    if (v + 1 < height_)
      tryAdd(u, v + 1, region);
  }

  void growFrom(const Seed& seed)
  {
    int taken = 0;
    for (int y = seed.v; y < seed.v + CELL_PX; ++y)
      for (int x = seed.u; x < seed.u + CELL_PX; ++x)
        taken += labels_.at<std::int16_t>(y, x) != NO_PLANE;
    GrownPlane grown;
    if (taken > CELL_PX * CELL_PX / 4 || !seed.moments.fit(Eigen::Vector3d::Zero(), &grown.plane))
      return;

    Region region{ static_cast<std::int16_t>(planes_.size()), {}, 0, cos_angle_, &grown.moments };
    region.setPlane(grown.plane);
    queue_.clear();
    for (int y = seed.v; y < seed.v + CELL_PX; ++y)
      for (int x = seed.u; x < seed.u + CELL_PX; ++x)
        tryAdd(x, y, region);
    int next_refit = 2 * CELL_PX * CELL_PX;
    for (std::size_t head = 0; head < queue_.size(); ++head)
    {
      if (grown.moments.count >= next_refit && grown.moments.fit(Eigen::Vector3d::Zero(), &grown.plane))
      {
        region.setPlane(grown.plane);
        next_refit = 2 * grown.moments.count;
      }
      tryNeighbors(queue_[head], region);
    }
    if (grown.moments.count >= options_.min_pixels && grown.moments.fit(Eigen::Vector3d::Zero(), &grown.plane))
    {
      planes_.push_back(grown);
      return;
    }
    for (const int index : queue_)
      labels_.at<std::int16_t>(index / width_, index % width_) = NO_PLANE;
  }

  /// Grows a finished region over pixels whose distance fits but whose normal was too rough.
  void extend(std::int16_t label, GrownPlane* grown)
  {
    Region region{ label, {}, 0, ROUGH_NORMAL_COS, &grown->moments };
    region.setPlane(grown->plane);
    queue_.clear();
    for (int index = 0; index < width_ * height_; ++index)
      if (labels_.at<std::int16_t>(index / width_, index % width_) == label)
        queue_.push_back(index);
    for (std::size_t head = 0; head < queue_.size(); ++head)
      tryNeighbors(queue_[head], region);
    grown->moments.fit(Eigen::Vector3d::Zero(), &grown->plane);
  }

  /// Root mean square of the region's distances to its plane, in sigmas of the noise model alone.
  double noiseScale(std::int16_t label, const geometry::Plane& plane) const
  {
    const Eigen::Vector3f n = plane.normal.cast<float>();
    const auto offset_m = static_cast<float>(plane.offset_m);
    double sum = 0;
    int count = 0;
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u)
        if (labels_.at<std::int16_t>(v, u) == label)
        {
          const Eigen::Vector3f p = image_.frame.point(u, v);
          const double residual = (n.dot(p) + offset_m) / noise_->sigmaAlong_m(n, p);
          sum += residual * residual;
          ++count;
        }
    return count > 0 ? std::max(1.0, std::sqrt(sum / count)) : 1;
  }

  /// Whether one plane explains both regions about as well as their own planes do.
  bool coplanar(const GrownPlane& a, const GrownPlane& b, GrownPlane* joint) const
  {
    if (a.plane.normal.dot(b.plane.normal) < cos_angle_)
      return false;
    joint->moments = a.moments;
    joint->moments.add(b.moments);
    if (!joint->moments.fit(Eigen::Vector3d::Zero(), &joint->plane))
      return false;
    for (const GrownPlane* part : { &a, &b })
      if (part->moments.meanSquare(joint->plane) > std::max(2.0, 1.5 * part->moments.meanSquare(part->plane)))
        return false;
    return true;
  }

  void joinCoplanar()
  {
    joined_into_.resize(planes_.size());
    for (std::size_t i = 0; i < planes_.size(); ++i)
      joined_into_[i] = static_cast<int>(i);
    for (bool changed = true; changed;)
    {
      changed = false;
      for (std::size_t i = 0; i < planes_.size(); ++i)
        for (std::size_t j = i + 1; j < planes_.size() && joined_into_[i] == static_cast<int>(i); ++j)
        {
          GrownPlane joint;
          if (joined_into_[j] != static_cast<int>(j) || !coplanar(planes_[i], planes_[j], &joint))
            continue;
          planes_[i] = joint;
          std::replace(joined_into_.begin(), joined_into_.end(), static_cast<int>(j), static_cast<int>(i));
          changed = true;
        }
    }
  }

  GrownPlanes sorted()
  {
    std::vector<int> order;
    for (std::size_t i = 0; i < planes_.size(); ++i)
      if (joined_into_[i] == static_cast<int>(i))
        order.push_back(static_cast<int>(i));
    std::stable_sort(order.begin(), order.end(),
                     [this](int a, int b) { return planes_[a].moments.count > planes_[b].moments.count; });
    GrownPlanes result;
    std::vector<std::int16_t> rank(planes_.size(), NO_PLANE);
    for (const int i : order)
    {
      rank[i] = static_cast<std::int16_t>(result.planes.size());
      result.planes.push_back(planes_[i]);
    }
    for (int v = 0; v < height_; ++v)
    {
      auto* row = labels_.ptr<std::int16_t>(v);
      for (int u = 0; u < width_; ++u)
        if (row[u] != NO_PLANE)
          row[u] = rank[joined_into_[row[u]]];
    }
    result.labels = labels_;  // shared: labels stay valid as planes are extended and joined again
    return result;
  }

  const WorkingImage& image_;
  std::shared_ptr<const NoiseTable> noise_;
  const PlaneGrowingOptions& options_;
  const float cos_angle_;
  const int width_, height_;
  cv::Mat labels_;
  std::vector<int> queue_;
  std::vector<GrownPlane> planes_;
  std::vector<int> joined_into_;
};

}  // namespace

GrownPlanes growPlanes(const WorkingImage& image, const PlaneGrowingOptions& options)
{
  return PlaneGrower(image, options).grow();
}

}  // namespace object_modelling::segmentation
