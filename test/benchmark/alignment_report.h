#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "alignment_truth.h"
#include "object_modelling/alignment/object_difference.h"

namespace object_modelling::benchmark_alignment
{
struct SessionRow
{
  std::string id;
  std::string session;  ///< that it is a part of
  std::string folder;   ///< of the recording
  std::string problem;  ///< why it was left out; empty if it was not
  std::size_t keyframes = 0;
  double made_s = 0;  ///< 0: it was in the cache
  double part_s = 0;  ///< time of its partial model
  registration::PartialModel part;
  SessionTruth truth;
  double mesh_distance_mm = 0;  ///< of the part, placed by the truth: of both what they are worth
};

struct PairRow
{
  std::string a, b;
  bool same_object = false;
  double seconds = 0;
  double same_pose_probability = 0;  ///< as it was aligned with
  alignment::PairAlignment result;
  // Of the same object only.
  double true_overlap = 0;
  double true_turn_rad = -1;  ///< by how much the object was turned over in between; negative: no support plane
  Eigen::Isometry3d T_a_b_true = Eigen::Isometry3d::Identity();
  std::vector<CandidateErrors> errors;                 ///< one per candidate
  std::optional<alignment::PairCandidate> from_truth;  ///< where the true pose ends, moved into place as they were
  CandidateErrors from_truth_errors;

  /// Of a candidate from the first one; of those that are not far less probable.
  std::vector<std::optional<alignment::DifferenceFeatures>> differences;
  std::vector<bool> right;  ///< one per candidate
  bool firstIsRight() const { return !right.empty() && right.front(); }
  std::optional<int> rankOfRight() const;  ///< of the first candidate that is right, from 1
};

/// With less overlap one alignment cannot be distinguished from another.
constexpr double ENOUGH_OVERLAP_RATIO = 0.2;

struct Counts
{
  int pairs = 0, right = 0, wrong = 0, refused = 0;
};

struct Summary
{
  Counts enough, little, cross;  ///< pairs of an object with enough true overlap and with little, and of two objects
  double median_s = 0, max_s = 0;
};

Summary summaryOf(const std::vector<PairRow>& pairs);

// Markdown.
std::string sessionTable(const std::vector<SessionRow>& sessions);
std::string pairTableHeader();
std::string toTableRow(const PairRow& pair);
std::string summaryText(const std::vector<SessionRow>& sessions, const std::vector<PairRow>& pairs);

nlohmann::json rowsOf(const Eigen::Isometry3d& T);  ///< four of four numbers
nlohmann::json toJson(const std::vector<SessionRow>& sessions, const std::vector<PairRow>& pairs);

}  // namespace object_modelling::benchmark_alignment
