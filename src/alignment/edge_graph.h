#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::alignment
{
constexpr double CHANCE = 0.05;  ///< that a pose of an edge is another one's though both are wrong

/// By how much two poses of one part differ.
struct PoseDifference
{
  double rotation_rad = 0, translation_m = 0;  ///< translation: of the part's centre

  bool small() const;
  std::string text() const;  ///< "12 deg and 3 mm"
};

/// A pose of a session, by the edge that it comes from.
struct Pose
{
  Eigen::Isometry3d T_reference_session = Eigen::Isometry3d::Identity();
  int edge = -1;
  double probability = 1;  ///< by that edge alone
};

using Placement = std::map<int, Pose>;  ///< by session

/// Sessions, and what their pairs make of poses. Sessions and edges go by their indices in what it is given; the edges
/// must outlive it.
class EdgeGraph
{
public:
  /// `min_probability`: what is needed for an edge to be accepted. One that was refused counts for less.
  EdgeGraph(const std::vector<registration::PartialModel>& parts, double min_probability,
            const std::vector<AlignmentEdge>& edges);

  int sessions() const { return static_cast<int>(centers_.size()); }
  int edges() const { return static_cast<int>(edges_.size()); }
  const std::pair<int, int>& ends(int edge) const { return ends_[edge]; }
  int otherEnd(int edge, int session) const;
  /// Whether an edge has poses that no person refused.
  /// A session whose shape is in doubt (PartialModel::doubt) is joined by a person alone: what is wrong in it agrees
  /// with itself.
  bool usable(int edge) const
  {
    return edges_[edge].best() && edges_[edge].decision != Decision::REFUSED &&
           (!doubtful_[edge] || edges_[edge].decision == Decision::ACCEPTED);
  }
  bool decided(int edge) const { return edges_[edge].decision != Decision::AUTOMATIC; }  ///< by a person
  bool holds(int edge, const Placement& placed) const;                                   ///< both ends are placed
  /// Usable edges between a session and those placed.
  std::vector<int> edgesTo(int session, const Placement& placed) const;

  std::size_t candidates(int edge) const;
  /// A pair placed by a person has hardly any doubt.
  double probability(int edge, std::size_t candidate) const;
  double doubt(int edge) const { return 1 - probability(edge, 0); }
  /// Of a candidate's probability what it has by itself, without those that make the same object.
  double ownProbability(int edge, std::size_t candidate) const;
  /// That none of an edge's candidates is right.
  double noneProbability(int edge) const;
  /// That two candidates of an edge make the same object, by way of the leading one.
  double sameObjectProbability(int edge, std::size_t one, std::size_t other) const;
  /// Probability that an edge agrees with a wrong pose by this candidate or another: the more of them make one object,
  /// the weaker the evidence of an agreement. A pose implied by other edges is there whether it is right or not, so
  /// that only the evidence of its own surfaces counts.
  double chance(int edge, std::size_t candidate) const;
  /// What an edge makes of a pose, against chance.
  double support(int edge, const std::optional<std::size_t>& agreeing) const;
  /// The same without the candidates that make the same object.
  double ownSupport(int edge, const std::optional<std::size_t>& agreeing) const;

  /// Pose of session `to` by an edge, from that of the session at its other end.
  Eigen::Isometry3d along(int edge, std::size_t candidate, int to, const Eigen::Isometry3d& T_reference_from) const;
  PoseDifference between(const Eigen::Isometry3d& one, const Eigen::Isometry3d& other, int session) const;
  /// The edge's pose with most support that is the one given of session `to`; none if there is none.
  std::optional<std::size_t> agreeing(int edge, int to, const Eigen::Isometry3d& T_reference_to,
                                      const Pose& from) const;
  std::optional<std::size_t> agreeing(int edge, const Placement& placed) const;
  /// By how much an edge's best pose contradicts the placement.
  PoseDifference contradiction(int edge, const Placement& placed) const;

private:
  double capped(int edge, double found) const;

  const std::vector<AlignmentEdge>& edges_;
  double refused_probability_;
  std::vector<Eigen::Vector3d> centers_;
  std::vector<bool> doubtful_;  // by edge: either session is
  std::vector<std::pair<int, int>> ends_;
  std::vector<std::vector<double>> own_;  ///< by edge and candidate
  std::vector<double> same_sums_;         ///< by edge, over its candidates
};

}  // namespace object_modelling::alignment
