#include "icp_matches.h"

#include "object_modelling/base/statistics.h"
#include "object_modelling/geometry/image_sampling.h"

#include <algorithm>
#include <cmath>

namespace object_modelling::multi_view_icp
{
namespace
{
constexpr float MIN_DEPTH_M = 0.05F;
constexpr float GATE_SIGMAS = 4;
constexpr float FIT_SIGMAS = 3;
constexpr float HIDDEN_M = 0.02F;     // behind a's surface by more: a cannot see it
constexpr float RIM_PX = 1;           // by which the place of a rim is unsure
constexpr float MIN_REACH_M = 0.01F;  // how far from the point its surface is looked for, at least
constexpr float SEEN_THROUGH_M = 0.006F;
constexpr float MIN_COLOR_SIGMA = 4;  // grey levels: sensor noise and interpolation
constexpr std::size_t MIN_COLOR_POINTS = 30;
constexpr float MIN_GAIN = 0.7F, MAX_GAIN = 1.4F;

/// How well a place of a's surface suits a point, in squared metres; normals that differ count as distance.
float mismatch(const IcpView& a, const Eigen::Vector3f& q, const Eigen::Vector3f& n, float normal_scale_m, int u, int v)
{
  return (a.point(u, v) - q).squaredNorm() + normal_scale_m * normal_scale_m * (1 - n.dot(a.normal(u, v)));
}

/// The pixel of a that suits a point best, searched round its projection in ever smaller steps; false if none is
/// usable.
bool searchPartner(const IcpView& a, const geometry::Projection<float>& at, const Eigen::Vector3f& q,
                   const Eigen::Vector3f& n, float gate_m, cv::Point* partner)
{
  if (!at.inside)
    return false;
  const cv::Rect image({ 0, 0 }, a.size());
  cv::Point center(at.column, at.row);
  const int radius = std::min(40, cvRound(gate_m * a.focal_px() / q.z()));
  float best = a.has(center.x, center.y) ? mismatch(a, q, n, gate_m, center.x, center.y) : INFINITY;
  *partner = center;
  for (int step = (radius + 1) / 2; step >= 1; step /= 2)
  {
    center = *partner;
    const int reach = step == (radius + 1) / 2 ? 2 : 1;
    for (int dv = -reach; dv <= reach; ++dv)
    {
      for (int du = -reach; du <= reach; ++du)
      {
        const cv::Point candidate(center.x + du * step, center.y + dv * step);
        if ((du == 0 && dv == 0) || !image.contains(candidate) || !a.has(candidate.x, candidate.y))
          continue;
        const float value = mismatch(a, q, n, gate_m, candidate.x, candidate.y);
        if (value >= best)
          continue;
        best = value;
        *partner = candidate;
      }
    }
  }
  return std::isfinite(best);
}

/// Whether a sees the point by the current poses: within the image, and not hidden.
bool inView(const IcpView& a, const geometry::Projection<float>& at, const Eigen::Vector3f& q, const Eigen::Vector3f& n,
            float gate_m)
{
  return at.inside && q.z() >= MIN_DEPTH_M && n.dot(q) < 0 && a.has(at.column, at.row) &&
         a.visibilityOf(at, HIDDEN_M + gate_m) != rgbd::Visibility::BEHIND;
}

/// Where a's surface is smooth along the viewing ray of a point and farther away than it: no surface is at the point.
bool seenThrough(const IcpView& a, const geometry::Projection<float>& at, float noise_m)
{
  return a.visibilityOf(at, SEEN_THROUGH_M + GATE_SIGMAS * noise_m) == rgbd::Visibility::IN_FRONT;
}

/// The place of a's surface nearest to a point that a sees through; false if there is none within reach.
bool nearestRim(const IcpView& a, const geometry::Projection<float>& at, const Eigen::Vector3f& q, float reach_m,
                Eigen::Vector3f* rim)
{
  const int radius = std::clamp(static_cast<int>(reach_m * a.focal_px() / q.z()), 2, 24);
  const int step = radius > 8 ? 2 : 1;
  float best = reach_m * reach_m;
  bool found = false;
  for (int v = std::max(0, at.row - radius); v <= std::min(a.size().height - 1, at.row + radius); v += step)
  {
    for (int u = std::max(0, at.column - radius); u <= std::min(a.size().width - 1, at.column + radius); u += step)
    {
      if (!(std::abs(a.depth_m(u, v) - q.z()) < reach_m))
        continue;
      const Eigen::Vector3f p = a.point(u, v);
      const float squared = (p - q).squaredNorm();
      if (squared >= best)
        continue;
      best = squared;
      *rim = p;
      found = true;
    }
  }
  return found;
}

/// True surface never lies where another view sees through. Points of b's rims that do are pulled back to a's surface,
/// each in the form of a match with a plane at the rim there, which is known to a pixel.
void matchRims(const IcpView& a, const IcpView& b, const Eigen::Isometry3f& T_a_b, const IcpStage& stage,
               IcpMatches* matches)
{
  const auto gate_m = static_cast<float>(stage.gate_m);
  for (const Eigen::Vector3f& p_b : b.rimPoints())
  {
    const Eigen::Vector3f q = T_a_b * p_b;
    const geometry::Projection<float> at = a.project(q);
    SurfaceMatch match;
    if (q.z() < MIN_DEPTH_M || !seenThrough(a, at, 0) ||
        !nearestRim(a, at, q, std::max(MIN_REACH_M, gate_m), &match.p_a))
      continue;
    const Eigen::Vector3f ray = q.normalized();
    Eigen::Vector3f sideways = q - match.p_a;
    sideways -= ray.dot(sideways) * ray;
    const float pixel_m = q.z() / a.focal_px();
    const float distance_m = sideways.norm();
    if (distance_m <= RIM_PX * pixel_m)
      continue;
    match.p_b = p_b;
    match.n_a = sideways / distance_m;
    match.p_a += RIM_PX * pixel_m * match.n_a;
    match.noise_m = pixel_m;
    match.sigma_m = std::hypot(pixel_m, 0.3F * gate_m);
    matches->surface.push_back(match);
  }
}

void matchColors(const IcpView& a, const IcpView& b, const Eigen::Isometry3f& T_a_b, const IcpStage& stage,
                 IcpMatches* matches)
{
  if (a.images().empty() || b.images().empty())
    return;
  const IcpImage& image = a.images()[stage.color_level];
  const auto gate_m = static_cast<float>(stage.gate_m);
  std::vector<float> seen;
  double sum_a = 0, sum_b = 0, square_a = 0, square_b = 0;
  for (std::size_t i = 0; i < b.colorPoints().size(); i += stage.point_step)
  {
    const IcpPoint& point = b.colorPoints()[i];
    const Eigen::Vector3f q = T_a_b * point.p;
    const geometry::Projection<float> at = a.project(q);
    if (!inView(a, at, q, T_a_b.linear() * point.n, gate_m))
      continue;
    // Something else in front or behind: only if the surface is where the point is do their grey levels compare.
    if (a.visibilityOf(at, gate_m + GATE_SIGMAS * point.sigma_m) != rgbd::Visibility::ON)
      continue;
    float intensity;
    Eigen::Vector2f gradient;
    if (!geometry::sampleGray(image.gray, image.fx * q.x() / q.z() + image.cx, image.fy * q.y() / q.z() + image.cy,
                              &intensity, &gradient))
      continue;
    const float expected = point.intensity[stage.color_level];
    matches->color.push_back({ point.p, expected });
    seen.push_back(intensity);
    sum_a += intensity;
    sum_b += expected;
    square_a += intensity * intensity;
    square_b += expected * expected;
  }
  if (seen.size() < MIN_COLOR_POINTS)
  {
    matches->color.clear();
    return;
  }
  // Exposure differs from view to view: equal mean and spread over what both see.
  const auto count = static_cast<double>(seen.size());
  const double variance_a = std::max(1.0, square_a / count - sum_a * sum_a / count / count);
  const double variance_b = std::max(1.0, square_b / count - sum_b * sum_b / count / count);
  const float gain = std::clamp(static_cast<float>(std::sqrt(variance_a / variance_b)), MIN_GAIN, MAX_GAIN);
  const auto mean_a = static_cast<float>(sum_a / count), mean_b = static_cast<float>(sum_b / count);
  std::vector<float> sizes(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    float& expected = matches->color[i].intensity;
    expected = mean_a + gain * (expected - mean_b);
    sizes[i] = std::abs(seen[i] - expected);
  }
  matches->color_sigma = std::max(MIN_COLOR_SIGMA, 1.4826F * base::median(&sizes));
}
}  // namespace

IcpMatches matchSurface(const IcpView& a, const IcpView& b, const Eigen::Isometry3d& T_a_b, const IcpStage& stage,
                        const NearestPoints* nearest)
{
  IcpMatches matches;
  const Eigen::Isometry3f T = T_a_b.cast<float>();
  const auto gate_m = static_cast<float>(stage.gate_m);
  const auto min_cosine = static_cast<float>(stage.min_normal_cosine);
  for (std::size_t i = 0; i < b.surfacePoints().size(); i += stage.point_step)
  {
    const IcpPoint& point = b.surfacePoints()[i];
    const Eigen::Vector3f q = T * point.p;
    const Eigen::Vector3f n = T.linear() * point.n;
    if (q.z() < MIN_DEPTH_M)
      continue;
    const geometry::Projection<float> at = a.project(q);
    const bool in_view = inView(a, at, q, n, gate_m);
    matches.in_view += in_view;
    SurfaceMatch match;
    match.p_b = point.p;
    if (nearest != nullptr)
    {
      if (!nearest->find(q, &match.p_a, &match.n_a))
        continue;
    }
    else
    {
      cv::Point partner;
      if (!searchPartner(a, at, q, n, gate_m, &partner))
        continue;
      match.p_a = a.point(partner.x, partner.y);
      match.n_a = a.normal(partner.x, partner.y);
    }
    const float sigma_a_m = a.surfaceSigma_m(match.p_a, match.n_a);
    const float noise_m = std::sqrt(point.sigma_m * point.sigma_m + sigma_a_m * sigma_a_m);
    const float distance_m = std::abs(match.n_a.dot(q - match.p_a));
    if (n.dot(match.n_a) < min_cosine || distance_m > gate_m + GATE_SIGMAS * noise_m)
      continue;
    match.noise_m = noise_m;
    match.sigma_m = std::hypot(noise_m, 0.3F * gate_m);
    matches.surface.push_back(match);
    matches.fitting += in_view && !seenThrough(a, at, noise_m) && distance_m < FIT_SIGMAS * noise_m;
  }
  return matches;
}

IcpMatches matchViews(const IcpView& a, const IcpView& b, const Eigen::Isometry3d& T_a_b, const IcpStage& stage,
                      const NearestPoints* nearest)
{
  IcpMatches matches = matchSurface(a, b, T_a_b, stage, nearest);
  if (stage.rims)
    matchRims(a, b, T_a_b.cast<float>(), stage, &matches);
  matchColors(a, b, T_a_b.cast<float>(), stage, &matches);
  return matches;
}

}  // namespace object_modelling::multi_view_icp
