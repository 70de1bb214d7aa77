#include "object_modelling/registration/pair_measure.h"

#include <algorithm>
#include <cmath>

#include "color_comparison.h"
#include "object_modelling/registration/support_contact.h"
#include "object_modelling/rgbd/visibility.h"

namespace object_modelling::registration
{
namespace
{
constexpr float MIN_SURFACE_COSINE = 0.7F;
constexpr double SAME_SURFACE_SPACINGS = 1.7;
constexpr float MAX_FEATURE_DISTANCE_M = 0.004F, MAX_FEATURE_RATIO = 0.08F;  // of the radius
constexpr float SPACE_SIGMAS = 3;
constexpr float SPACE_MARGIN_M = 0.004F;  // registration and calibration, beyond noise

/// Sums for the correlation of the slopes of the colours. Either part is the fixed one once, so that it is that within
/// pairs without order (intraclass, Fisher 1925): slopes that are steeper in one part are not all alike.
struct EdgeComparison
{
  double ff = 0, mm = 0, fm = 0;

  void add(const ColorGradient& of_fixed, const ColorGradient& of_moving)
  {
    ff += of_fixed.squaredNorm();
    mm += of_moving.squaredNorm();
    fm += of_fixed.cwiseProduct(of_moving).sum();
  }
  double strength() const { return std::sqrt(ff * mm); }
};

/// The points of one part against the surface and the views of the other.
struct SurfaceComparison
{
  double total = 0, same = 0, squares = 0;  // squares: of the point-to-plane distances, m^2
  double front = 0, upheld = 0;             // points that the other's views look through, or see
  EdgeComparison edges;
};

/// Whether the views see a point in front of what they measured, or on it: the majority decides, so that the noise of a
/// silhouette in one view has no effect.
void compareWithViews(const std::vector<SpaceView>& views, const Eigen::Vector3f& p, SurfaceComparison* comparison)
{
  int front = 0, upheld = 0;
  for (const SpaceView& view : views)
  {
    const Eigen::Vector3f q = view.T_camera_session * p;
    const float margin_m = SPACE_SIGMAS * static_cast<float>(view.axial_sigma_m) + SPACE_MARGIN_M;
    const rgbd::Visibility seen =
        rgbd::visibilityOf(geometry::projectionOf(view.camera, q), view.least_depth_m, margin_m);
    front += seen == rgbd::Visibility::IN_FRONT;
    upheld += seen == rgbd::Visibility::ON;
  }
  comparison->front += front > upheld && front >= 2;
  comparison->upheld += upheld >= front && upheld > 0;
}

SurfaceComparison compareSurfaces(const MatchedSurface& fixed, const MatchedSurface& moving,
                                  const Eigen::Isometry3f& T_fixed_moving, bool many, bool swapped,
                                  ColorComparison* colors)
{
  SurfaceComparison comparison;
  const auto reach_m =
      static_cast<float>(SAME_SURFACE_SPACINGS * std::max(fixed.model.spacing_m, moving.model.spacing_m));
  const Eigen::Matrix3f R = T_fixed_moving.linear();
  for (const int i : many ? moving.fine_samples : moving.coarse_samples)
  {
    const Eigen::Vector3f q = T_fixed_moving * moving.model.points[i];
    comparison.total += 1;
    compareWithViews(fixed.model.views, q, &comparison);
    const int j = fixed.fine.nearest(q);
    if (j < 0)
      continue;
    const Eigen::Vector3f& n = fixed.model.normals[j];
    const Eigen::Vector3f off = q - fixed.model.points[j];
    const float distance_m = n.dot(off);
    if (off.norm() > 1.5F * reach_m || std::abs(distance_m) > reach_m ||
        n.dot(R * moving.model.normals[i]) < MIN_SURFACE_COSINE)
      continue;
    comparison.same += 1;
    comparison.squares += distance_m * distance_m;
    const Eigen::Vector3f there =
        many ? Eigen::Vector3f(fixed.colors[j] + fixed.gradients[j] * (off - n * distance_m)) : fixed.blurred_colors[j];
    const Eigen::Vector3f& here = many ? moving.colors[i] : moving.blurred_colors[i];
    if (swapped)
      colors->add(here, there, moving.model.normals[i]);
    else
      colors->add(there, here, n);
    if (many)
      comparison.edges.add(static_cast<float>(fixed.slope_length_m) * fixed.blurred_gradients[j],
                           static_cast<float>(moving.slope_length_m) * moving.blurred_gradients[i] * R.transpose());
  }
  return comparison;
}

/// Angle between what was up in either session, as the object lies; negative where one of them is not known.
double turn_rad(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b)
{
  if (!a.model.support_plane || !b.model.support_plane)
    return -1;
  const Eigen::Vector3d up_b = T_a_b.linear().cast<double>() * b.model.support_plane->normal;
  return std::acos(std::clamp(a.model.support_plane->normal.dot(up_b), -1.0, 1.0));
}

void compareEdges(const SurfaceComparison& b_on_a, const SurfaceComparison& a_on_b, PairQuality* quality)
{
  EdgeComparison both = b_on_a.edges;
  both.ff += a_on_b.edges.ff;
  both.mm += a_on_b.edges.mm;
  both.fm += a_on_b.edges.fm;
  const double same = b_on_a.same + a_on_b.same;
  if (both.strength() <= 1e-9 * same)
    return;
  quality->edge_agreement = both.fm / both.strength();
  quality->edge_strength = std::sqrt(both.strength() / same);
}

}  // namespace

bool seenThrough(const std::vector<SpaceView>& views, const Eigen::Vector3f& p)
{
  SurfaceComparison comparison;
  compareWithViews(views, p, &comparison);
  return comparison.front > 0;
}

double coarseOverlap(const MatchedSurface& a, const MatchedSurface& b, const Eigen::Isometry3f& T_a_b)
{
  const auto reach_m = std::max(0.005F, 0.06F * a.radius_m);
  int same = 0;
  for (const int i : b.coarse_samples)
  {
    const Eigen::Vector3f q = T_a_b * b.model.points[i];
    const int j = a.coarse.nearest(q);
    same += j >= 0 && (q - a.model.points[j]).norm() < 2 * reach_m &&
            std::abs(a.model.normals[j].dot(q - a.model.points[j])) < reach_m &&
            a.model.normals[j].dot(T_a_b.linear() * b.model.normals[i]) > MIN_SURFACE_COSINE;
  }
  return b.coarse_samples.empty() ? 0 : static_cast<double>(same) / static_cast<double>(b.coarse_samples.size());
}

PairQuality measurePair(const PartPair& pair, const Eigen::Isometry3f& T_a_b, bool many)
{
  const MatchedSurface &a = pair.a, &b = pair.b;
  ColorComparison colors;
  const SurfaceComparison b_on_a = compareSurfaces(a, b, T_a_b, many, false, &colors);
  const SurfaceComparison a_on_b = compareSurfaces(b, a, T_a_b.inverse(), many, true, &colors);
  PairQuality quality;
  quality.overlap_ratio =
      std::max(b_on_a.same / std::max(1.0, b_on_a.total), a_on_b.same / std::max(1.0, a_on_b.total));
  const double front = b_on_a.front + a_on_b.front, upheld = b_on_a.upheld + a_on_b.upheld;
  quality.fsv_ratio = front + upheld > 0 ? front / (front + upheld) : 0;
  const double same = b_on_a.same + a_on_b.same;
  quality.rmse_m = same > 0 ? std::sqrt((b_on_a.squares + a_on_b.squares) / same) : 0;
  quality.contact_gap_m = contactGap_m(a, b, T_a_b);
  const ColorComparison::Result compared = colors.result();
  quality.color_agreement = compared.agreement;
  quality.texture = compared.texture;
  quality.light_variance = compared.light_variance;
  quality.foot_m = std::max(a.foot_m, b.foot_m);
  quality.turn_rad = turn_rad(a, b, T_a_b);
  quality.roughness_m = std::hypot(a.roughness_m, b.roughness_m);
  compareEdges(b_on_a, a_on_b, &quality);
  const float reach_m = std::min(MAX_FEATURE_DISTANCE_M, MAX_FEATURE_RATIO * std::min(a.radius_m, b.radius_m));
  quality.features_upheld = static_cast<double>(upholding(pair.matches, T_a_b, reach_m).size());
  return quality;
}

}  // namespace object_modelling::registration
