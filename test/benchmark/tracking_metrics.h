#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "object_modelling/geometry/transform.h"
#include "object_modelling/source/trajectory_file.h"

// Errors of a trajectory against the truth, as the TUM benchmark defines them [Sturm et al., IROS 2012].
namespace object_modelling::benchmark_tracking
{
/// When the scene is out of sight.
struct Event
{
  std::string type;
  double start_s = 0, end_s = 0;
};

struct ScoreOptions
{
  double rpe_delta_s = 1;
  double tolerance_s = 0.02;  ///< largest difference of the stamps of a pair
  double right_mm = 20;       ///< a pose farther from the truth than this, or than right_deg, is a wrong one
  double right_deg = 3;
};

struct Statistics
{
  double rmse = 0, mean = 0, median = 0, max = 0;
};

/// First frames after an event, counted among the frames of the estimate's recording; 1 is the first one after it.
struct Relocalisation
{
  Event event;
  std::optional<int> frames_to_pose;        ///< until any pose
  std::optional<int> frames_to_right_pose;  ///< until one within right_mm and right_deg
};

struct TrajectoryScore
{
  int matched = 0;  ///< poses compared, those within events left out
  int wrong = 0;    ///< of them, worse than right_mm or right_deg
  Statistics ate_mm, rotation_deg;
  /// RMSE of each minute in which poses were compared: whether errors grow with time.
  std::vector<double> ate_by_minute_mm;
  std::optional<Statistics> rpe_mm, rpe_deg;
  std::vector<Relocalisation> relocalisations;
  /// Per pair: pose of the estimate in the truth's frame, the true one, and the distance.
  struct Pair
  {
    double stamp_s = 0;
    Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity(), truth = Eigen::Isometry3d::Identity();
    double position_mm = 0, rotation_deg = 0;
  };
  std::vector<Pair> pairs;
};

Statistics statisticsOf(std::vector<double> values);

/// Indices of the mutually nearest stamps not more than `tolerance_s` apart; both in ascending order.
std::vector<std::pair<std::size_t, std::size_t>> associate(const std::vector<source::StampedPose>& a,
                                                           const std::vector<source::StampedPose>& b,
                                                           double tolerance_s);

/// T_a_b of two frames in which the same cameras are known: rigid, by positions; where these span less than a line,
/// by the mean rotation and the mean position.
Eigen::Isometry3d alignTrajectories(const std::vector<Eigen::Isometry3d>& T_a_camera,
                                    const std::vector<Eigen::Isometry3d>& T_b_camera);

/// Nothing if fewer than three poses match. With events, the poses before the first one alone align, and those within
/// events do not count. `frame_stamps_s`: of all frames fed to the tracker, for counting after events.
std::optional<TrajectoryScore> scoreTrajectory(const std::vector<source::StampedPose>& estimate,
                                               const std::vector<source::StampedPose>& truth,
                                               const std::vector<Event>& events,
                                               const std::vector<double>& frame_stamps_s,
                                               const ScoreOptions& options = {});

struct EstimateWithCovariance
{
  source::StampedPose pose;
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
};

/// Normalised estimation error squared: xi^T C^-1 xi with T_true = exp(xi) T_estimated.
struct Nees
{
  int count = 0;            ///< poses with a covariance; the first has none, as it makes the frame
  double within_ratio = 0;  ///< share within the 95 % bound of chi-square with 6 degrees of freedom, 12.59
  double median = 0;        ///< 5.35 if errors are as large as they claim; 0: none counted
};

/// The truth is brought into the estimate's frame by the first pair.
Nees neesOf(const std::vector<EstimateWithCovariance>& estimate, const std::vector<source::StampedPose>& truth,
            double tolerance_s);

}  // namespace object_modelling::benchmark_tracking
