#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/pipeline/session_refinement.h"

namespace object_modelling::pipeline
{
/// The steps of refinement on the keyframes of one session, and the choice among what they make.
class Refiner
{
public:
  /// `options`, with object_only as the session has it. `color_offset_px`: of the frames, as far as it is known before.
  /// `control` must outlive this.
  Refiner(RefinementOptions options, std::vector<rgbd::Keyframe> keyframes, const Eigen::Vector2d& color_offset_px,
          base::JobControl& control);

  SessionRefinement run();
  /// With the poses that were chosen.
  const std::vector<rgbd::Keyframe>& keyframes() const { return keyframes_; }

private:
  /// Poses that the session may get.
  struct Candidate
  {
    std::string by;
    multi_view_icp::PoseSet poses;
    std::vector<geometry::Matrix6d> covariance;
  };
  static Candidate candidateOf(const std::string& by, multi_view_icp::PoseSet poses,
                               std::vector<geometry::Matrix6d> covariance);

  void adjustBundle();
  void alignSurfaces();
  void alignSurfacesAlone();
  /// Whether frames were corrected on the way: poses from before are not of the same frames any more.
  bool corrected() const;
  bool objectOnly() const { return options_.bundle_adjustment.object_only || options_.multi_view_icp.object_only; }
  /// Whether depths agree less after bundle adjustment than before.
  bool drivesSurfacesApart() const;
  void choose();
  std::vector<multi_view_icp::PoseScore> scores() const;
  void place(const Candidate& candidate);

  RefinementOptions options_;
  std::vector<rgbd::Keyframe> keyframes_;
  base::JobControl& control_;
  SessionRefinement refined_;
  std::vector<Candidate> candidates_;  ///< that came, and of each step that succeeded; what was asked for last
  std::optional<multi_view_icp::MultiViewIcpResult> alone_;
};

}  // namespace object_modelling::pipeline
