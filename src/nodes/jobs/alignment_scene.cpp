#include "alignment_scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "alignment_message.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::nodes
{
namespace
{
constexpr double PITCH_RADII = 2.6;  // from one place to the next
constexpr double LETTER_RADII = 0.16;
constexpr double NEAR_SPACINGS = 4;  // a click that is farther from a part's points is none on it
const AlignmentScene::Color BLUE(86, 180, 233), ORANGE(230, 159, 0);  // Okabe and Ito's palette
const Eigen::Vector3d LIGHT = Eigen::Vector3d(0.3, -0.6, 0.75).normalized();

/// Turns a session's up to z and its part's centre to the origin.
Eigen::Isometry3d uprightFrom(const registration::PartialModel& part)
{
  const Eigen::Vector3d up =
      part.support_plane ? part.support_plane->normal : Eigen::Vector3d(0, -1, 0);  // of a camera held level
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = geometry::rotationBetween(up, Eigen::Vector3d::UnitZ());
  T.translation() = -T.linear() * part.center().cast<double>();
  return T;
}

Eigen::Isometry3d movedTo(const Eigen::Vector3d& place, const Eigen::Isometry3d& T)
{
  return Eigen::Translation3d(place) * T;
}

std::string textOf(const alignment::PairCandidate& candidate, std::size_t number)
{
  std::ostringstream out;
  out.setf(std::ios::fixed);
  out.precision(2);
  out << number << ": " << alignment::nameOf(candidate.kind) << "\nprobability " << candidate.quality.probability
      << "\noverlap " << std::lround(100 * candidate.quality.overlap_ratio) << " %, violation "
      << std::lround(100 * candidate.quality.fsv_ratio) << " %";
  return out.str();
}
}  // namespace

AlignmentScene::AlignmentScene(PartPointer a, PartPointer b, const alignment::AlignmentEdge& edge)
    : a_(std::move(a)), b_(std::move(b))
{
  const double radius_m = std::max(a_->radius_m(), b_->radius_m());
  pitch_m_ = PITCH_RADII * radius_m;
  letter_m_ = LETTER_RADII * radius_m;
  const Eigen::Isometry3d upright_a = uprightFrom(*a_);
  T_display_a_ = movedTo({ -0.5 * pitch_m_, -pitch_m_, 0 }, upright_a);
  T_display_b_ = movedTo({ 0.5 * pitch_m_, -pitch_m_, 0 }, uprightFrom(*b_));
  add(*a_, T_display_a_, nullptr);
  add(*b_, T_display_b_, nullptr);
  const Eigen::Vector3d above(0, 0, 1.25 * radius_m);
  labels_.push_back({ Eigen::Vector3d(-0.5 * pitch_m_, -pitch_m_, 0) - above, a_->session_id + " (blue)" });
  labels_.push_back({ Eigen::Vector3d(0.5 * pitch_m_, -pitch_m_, 0) - above, b_->session_id + " (orange)" });
  const std::size_t shown = std::min(SHOWN_CANDIDATES, edge.candidates.size());
  for (std::size_t i = 0; i < shown; ++i)
  {
    const Eigen::Vector3d place(pitch_m_ * (static_cast<double>(i) - 1), 0, 0);
    const alignment::PairCandidate& candidate = edge.candidates[i];
    add(*a_, movedTo(place, upright_a), &BLUE);
    add(*b_, movedTo(place, upright_a * candidate.T_a_b), &ORANGE);
    const bool chosen = edge.accepted && i == 0;
    const std::string by = edge.decision == alignment::Decision::ACCEPTED ? "\nCHOSEN by a person" : "\nCHOSEN";
    labels_.push_back({ place + above, textOf(candidate, i) + (chosen ? by : ""), chosen ? Tone::GOOD : Tone::PLAIN });
  }
  if (!edge.reason.empty())
    labels_.push_back({ Eigen::Vector3d(0, 0, 2.1 * radius_m), edge.reason, Tone::BAD });
}

void AlignmentScene::add(const registration::PartialModel& part, const Eigen::Isometry3d& T_display_part,
                         const Color* tint)
{
  for (std::size_t i = 0; i < part.points.size(); ++i)
  {
    points_.emplace_back((T_display_part * part.points[i].cast<double>()).cast<float>());
    if (!tint)
    {
      colors_.push_back(part.colors_rgb[i]);
      continue;
    }
    const double shade = std::max(0.0, LIGHT.dot(T_display_part.linear() * part.normals[i].cast<double>()));
    colors_.emplace_back((tint->cast<double>() * (0.45 + 0.55 * shade)).cast<std::uint8_t>());
  }
}

Eigen::Vector3d AlignmentScene::noticePosition() const
{
  return { 0, -1.6 * pitch_m_, -0.3 * pitch_m_ };
}

std::optional<AlignmentScene::Spot> AlignmentScene::spotAt(const Eigen::Vector3d& p_display) const
{
  std::optional<Spot> nearest;
  double best_m = NEAR_SPACINGS * std::max(a_->spacing_m, b_->spacing_m);
  for (const bool in_a : { true, false })
  {
    const Eigen::Vector3d p = (in_a ? T_display_a_ : T_display_b_).inverse() * p_display;
    for (const Eigen::Vector3f& point : (in_a ? *a_ : *b_).points)
    {
      const double distance_m = (point.cast<double>() - p).norm();
      if (distance_m >= best_m)
        continue;
      best_m = distance_m;
      nearest = Spot{ in_a, point.cast<double>() };
    }
  }
  return nearest;
}

Eigen::Vector3d AlignmentScene::displayed(const Spot& spot) const
{
  return (spot.in_a ? T_display_a_ : T_display_b_) * spot.p_session;
}

}  // namespace object_modelling::nodes
