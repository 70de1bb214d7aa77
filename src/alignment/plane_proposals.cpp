#include <algorithm>
#include <cmath>

#include "object_modelling/geometry/convex_hull.h"
#include "object_modelling/geometry/transform.h"
#include "proposals.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MERGE_COSINE = 0.966;  // 15 deg: a rounded or noisy face is many facets
constexpr float FACE_DEPTH_RATIO = 0.04F;
constexpr int ROTATIONS = 48;
constexpr double MIN_FOOT_RATIO = 0.03;  // of the squared radius: smaller faces are corners
constexpr double STABLE_MARGIN_RATIO = 0.15;

/// A way to stand: the direction of the face, and how far from the centre it is.
struct Foot
{
  Eigen::Vector3f normal;  ///< outward
  float distance_m = 0;    ///< of the plane from the part's centre
};

/// Whether the centre projects into the face, or so near to it that an incomplete part could mislead; and the face is
/// large enough.
bool standsOn(const registration::MatchedSurface& part, const std::vector<Eigen::Vector3f>& hull, const Foot& foot)
{
  const Eigen::Vector3f x = foot.normal.unitOrthogonal(), y = foot.normal.cross(x);
  Eigen::Vector2f low = Eigen::Vector2f::Constant(1e9F), high = -low;
  for (const Eigen::Vector3f& vertex : hull)
  {
    const Eigen::Vector3f off = vertex - part.center;
    if (foot.distance_m - foot.normal.dot(off) > FACE_DEPTH_RATIO * part.radius_m)
      continue;
    const Eigen::Vector2f at(x.dot(off), y.dot(off));
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  const auto margin = static_cast<float>(STABLE_MARGIN_RATIO) * part.radius_m;
  return (low.array() < margin).all() && (high.array() > -margin).all() &&
         (high - low).prod() > MIN_FOOT_RATIO * part.radius_m * part.radius_m;
}

std::vector<Foot> feetOf(const registration::MatchedSurface& part)
{
  const geometry::ConvexHull hull = geometry::convexHull(part.model.points);
  std::vector<Eigen::Vector3f> merged;
  for (const Eigen::Vector3d& normal : hull.normals)
  {
    const Eigen::Vector3f n = normal.cast<float>();
    if (std::none_of(merged.begin(), merged.end(),
                     [&](const Eigen::Vector3f& known) { return known.dot(n) > MERGE_COSINE; }))
      merged.push_back(n);
  }
  std::vector<Foot> feet;
  for (const Eigen::Vector3f& n : merged)
  {
    Foot foot{ n, 0 };
    for (const Eigen::Vector3f& vertex : hull.vertices)
      foot.distance_m = std::max(foot.distance_m, n.dot(vertex - part.center));
    if (standsOn(part, hull.vertices, foot))
      feet.push_back(foot);
  }
  return feet;
}

/// T_standing_moving for every foot of `moving` on the plane of `standing`, above the middle of the latter.
std::vector<Eigen::Isometry3f> placements(const registration::MatchedSurface& standing,
                                          const registration::MatchedSurface& moving)
{
  std::vector<Eigen::Isometry3f> result;
  if (!standing.model.support_plane)
    return result;
  const Eigen::Vector3f up = standing.model.support_plane->normal.cast<float>();
  const auto height =
      static_cast<float>(standing.model.support_plane->signedDistance_m(standing.center.cast<double>()));
  for (const Foot& foot : feetOf(moving))
  {
    const Eigen::Matrix3f upright = geometry::rotationBetween(foot.normal, Eigen::Vector3f(-up));
    for (int i = 0; i < ROTATIONS; ++i)
    {
      Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
      T.linear() = Eigen::AngleAxisf(static_cast<float>(2 * M_PI * i / ROTATIONS), up).toRotationMatrix() * upright;
      T.translation() = standing.center + up * (foot.distance_m - height) - T.linear() * moving.center;
      result.push_back(T);
    }
  }
  return result;
}
}  // namespace

std::vector<Proposal> proposeByStablePlanes(const registration::MatchedSurface& a,
                                            const registration::MatchedSurface& b)
{
  std::vector<Proposal> proposals;
  for (const Eigen::Isometry3f& T_a_b : placements(a, b))
    proposals.push_back({ ProposalKind::STABLE_PLANE, T_a_b });
  for (const Eigen::Isometry3f& T_b_a : placements(b, a))
    proposals.push_back({ ProposalKind::STABLE_PLANE, T_b_a.inverse() });
  return proposals;
}

}  // namespace object_modelling::alignment
