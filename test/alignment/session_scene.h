#pragma once

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/geometry/transform.h"

namespace object_modelling::alignment
{
constexpr double MIN_PROBABILITY = 0.57;

/// Sessions of one object, each about 0.8 m from its camera and turned as it may be; what their pairs say is exact.
class SessionsOfAnObject : public testing::Test
{
protected:
  explicit SessionsOfAnObject(int count = 6)
  {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 1);
    for (int i = 0; i < count; ++i)
    {
      const Eigen::Quaterniond R{ normal(random), normal(random), normal(random), normal(random) };
      T_session_object_.push_back(geometry::isometryFrom(
          R.normalized(), { 0.1 * normal(random), 0.1 * normal(random), 0.8 + 0.1 * normal(random) }));
      registration::PartialModel part;
      part.session_id = nameOf(i);
      const Eigen::Vector3f center = T_session_object_.back().translation().cast<float>();
      part.points = { center - Eigen::Vector3f::Constant(0.05F), center + Eigen::Vector3f::Constant(0.05F) };
      parts_.push_back(part);
    }
  }

  static std::string nameOf(int session) { return std::string(1, static_cast<char>('a' + session)); }
  Eigen::Isometry3d truth(int a, int b) const { return T_session_object_[a] * T_session_object_[b].inverse(); }

  /// `T_off`: where the edge says b's object is, in a's object.
  AlignmentEdge edge(int a, int b, double probability,
                     const Eigen::Isometry3d& T_off = Eigen::Isometry3d::Identity()) const
  {
    PairCandidate candidate;
    candidate.T_a_b = T_session_object_[a] * T_off * T_session_object_[b].inverse();
    candidate.quality.probability = probability;
    return { nameOf(a), nameOf(b), Decision::AUTOMATIC, true, false, "", { candidate } };
  }
  AlignmentEdge refused(int a, int b) const
  {
    AlignmentEdge result = edge(a, b, 0.05, shifted(0.3));
    result.accepted = false;
    result.reason = "colours disagree";
    return result;
  }
  static Eigen::Isometry3d shifted(double distance_m)
  {
    return Eigen::Isometry3d(Eigen::Translation3d(0, distance_m, 0));
  }
  static Eigen::Isometry3d turned(double angle_rad)
  {
    return Eigen::Isometry3d(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized()));
  }

  std::vector<registration::PartialModel> parts_;
  std::vector<Eigen::Isometry3d> T_session_object_;
};

}  // namespace object_modelling::alignment
