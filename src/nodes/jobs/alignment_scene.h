#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::nodes
{
/// Two parts as a person looks at them: in front each alone in its colours, to be clicked on; behind them the best
/// candidates side by side, one part blue and the other orange. z up as part a stood; m.
class AlignmentScene
{
public:
  using Color = Eigen::Matrix<std::uint8_t, 3, 1>;
  using PartPointer = std::shared_ptr<const registration::PartialModel>;
  enum class Tone
  {
    PLAIN,
    GOOD,
    BAD
  };
  struct Label
  {
    Eigen::Vector3d position;
    std::string text;
    Tone tone = Tone::PLAIN;
  };
  /// A point on one of the parts that stand alone.
  struct Spot
  {
    bool in_a = false;
    Eigen::Vector3d p_session;
  };

  /// The parts in the order of the edge's sessions.
  AlignmentScene(PartPointer a, PartPointer b, const alignment::AlignmentEdge& edge);

  const std::vector<Eigen::Vector3f>& points() const { return points_; }
  const std::vector<Color>& colors() const { return colors_; }
  const std::vector<Label>& labels() const { return labels_; }
  double letterHeight_m() const { return letter_m_; }
  Eigen::Vector3d noticePosition() const;  ///< of a line to the person, in front of all
  const registration::PartialModel& a() const { return *a_; }
  const registration::PartialModel& b() const { return *b_; }

  /// The point of a lone part next to a displayed one; nothing where none is near.
  std::optional<Spot> spotAt(const Eigen::Vector3d& p_display) const;
  Eigen::Vector3d displayed(const Spot& spot) const;

private:
  void add(const registration::PartialModel& part, const Eigen::Isometry3d& T_display_part, const Color* tint);

  PartPointer a_, b_;
  double pitch_m_ = 0, letter_m_ = 0;
  Eigen::Isometry3d T_display_a_, T_display_b_;  ///< of the parts that stand alone
  std::vector<Eigen::Vector3f> points_;
  std::vector<Color> colors_;
  std::vector<Label> labels_;
};

}  // namespace object_modelling::nodes
