#include "object_modelling/alignment/alignment_by_points.h"

#include <cmath>

#include <Eigen/Dense>

#include "object_modelling/alignment/pair_evidence.h"
#include "object_modelling/base/options.h"
#include "object_modelling/base/status.h"
#include "object_modelling/geometry/linear_systems.h"
#include "object_modelling/geometry/transform.h"
#include "object_modelling/registration/pair_refinement.h"

namespace object_modelling::alignment
{
namespace
{
constexpr double MIN_WIDTH_M = 0.01;      // of the points across their line: else the turn about it is not determined
constexpr double MAX_MISMATCH_M = 0.015;  // rms: a person hits the same spot within some millimetres
constexpr double MAX_MOVE_RATIO = 0.15;   // of the part's radius that ICP may move it from where the person put it
constexpr double MAX_TURN_RAD = 0.25;

base::Error refused(const std::string& what)
{
  return { base::StatusCode::INVALID_ARGUMENT, what };
}

std::string wholeMillimeters(double length_m)
{
  return std::to_string(std::lround(1000 * length_m)) + " mm";
}

/// Second largest spread of the points.
double widthOf(const Eigen::Matrix3Xd& points)
{
  const Eigen::Matrix3Xd off = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d scatter = off * off.transpose();
  return std::sqrt(std::max(0.0, geometry::eigenSystem(scatter).values[1]));
}
}  // namespace

PairCandidate alignByPoints(const registration::PartialModel& a, const registration::PartialModel& b,
                            const std::vector<PointPair>& pairs, const PairAlignmentOptions& options,
                            base::JobControl& control)
{
  base::checked(options);
  control.checkCancelled();
  if (a.points.empty() || b.points.empty())
    throw refused("session '" + (a.points.empty() ? a : b).session_id + "' shows no point of the object");
  if (pairs.size() < 3)
    throw refused(std::to_string(pairs.size()) + " pairs of points: three are needed");
  Eigen::Matrix3Xd in_a(3, pairs.size()), in_b(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    in_a.col(static_cast<Eigen::Index>(i)) = pairs[i].a;
    in_b.col(static_cast<Eigen::Index>(i)) = pairs[i].b;
  }
  if (!in_a.allFinite() || !in_b.allFinite())
    throw refused("a point is not finite");
  const double width_m = std::min(widthOf(in_a), widthOf(in_b));
  if (width_m < MIN_WIDTH_M)
    throw refused("the points lie on one line, or at one place (" + wholeMillimeters(width_m) +
                  " wide): choose them apart, in a triangle");
  Eigen::Isometry3d clicked;
  if (!geometry::rigidTransformFromPoints(in_a, in_b, &clicked))
    throw refused("the points do not tell a pose: choose them apart, in a triangle");
  const double mismatch_m = (in_a - clicked * in_b).norm() / std::sqrt(static_cast<double>(pairs.size()));
  if (mismatch_m > MAX_MISMATCH_M)
    throw refused("the points of the two sessions do not fit each other by " + wholeMillimeters(mismatch_m) +
                  " (at most " + wholeMillimeters(MAX_MISMATCH_M) + "): point at the same spots, in the same order");

  const registration::MatchedSurface part_a(a, options.threads), part_b(b, options.threads);
  control.checkCancelled();
  registration::PairIcpOptions coarse;
  coarse.gate_m = MAX_MOVE_RATIO * part_a.radius_m;
  coarse.last_gate_m = 0.3 * coarse.gate_m;
  Eigen::Isometry3f refined = registration::alignByIcp(part_a, part_b, clicked.cast<float>(), coarse);
  const registration::PartPair pair(part_a, part_b, options.threads);
  registration::PairQuality quality = registration::refinePairPose(pair, &refined);
  const Eigen::Vector3d center = b.center().cast<double>();
  const Eigen::Isometry3d T_a_b = geometry::normalized(refined.cast<double>());
  const bool near = geometry::rotationAngle_rad(clicked.inverse() * T_a_b) < MAX_TURN_RAD &&
                    (clicked * center - T_a_b * center).norm() < MAX_MOVE_RATIO * part_a.radius_m;
  // Where ICP would slide along the surfaces, the pose by the points is kept.
  if (!near)
    quality = registration::measurePair(pair, clicked.cast<float>(), true);
  quality.probability = 1 / (1 + std::exp(-logOdds(quality, options.same_pose_probability)));
  return { ProposalKind::BY_HAND, near ? T_a_b : clicked, quality };
}

}  // namespace object_modelling::alignment
