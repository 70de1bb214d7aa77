#pragma once

#include <optional>
#include <string>
#include <vector>

#include "object_modelling/pipeline/align_sessions.h"
#include "object_modelling/pipeline/build_object.h"
#include "object_modelling/pipeline/session_jobs.h"
#include "object_modelling/pipeline/session_refinement.h"

namespace object_modelling::pipeline
{
/// What the alignment hands to the build.
struct AlignedSessions
{
  base::Status status;  ///< OK: all placed, or with a message that names those left out and why
  std::vector<alignment::SessionPlacement> placements;
  std::vector<database::LeftOutSession> left_out;
};

/// The stages that make an object of stored sessions, wherever they are done. What a stage could not do is thrown as
/// base::Error, but that sessions do not fit each other is in the result of align().
class ModelStages
{
public:
  virtual ~ModelStages() = default;
  virtual keyframes::Session session(const std::string& session_id) = 0;
  virtual void refine(const std::vector<std::string>& session_ids, base::JobControl& control) = 0;
  virtual void segment(const std::vector<std::string>& session_ids, base::JobControl& control) = 0;
  virtual AlignedSessions align(const std::vector<std::string>& session_ids, base::JobControl& control) = 0;
  virtual base::Status build(const AlignedSessions& aligned, base::JobControl& control) = 0;
  /// Told before each stage, also before one that has nothing to do.
  virtual void onStage(const std::string& /*stage*/) {}
};

struct ModelOutcome
{
  /// Of the build, followed by the alignment's message; of the alignment alone where too few sessions fit. OK with a
  /// message: the object is there, but partial, or without texture or report.
  base::Status status;
  bool built = false;                  ///< false: too few sessions fit, or the status is that of a failed build
  std::vector<StageTime> stages;       ///< refine, segment, align and build, as far as they ran
  std::vector<std::string> unchanged;  ///< sessions that had been refined and segmented before
};

/// The one order of the stages: refine, segment, align, build. A session that bears the mark of a stage is not taken
/// through it again, unless `again`: a person may have chosen its object. Progress names the sessions that stay as
/// before.
ModelOutcome modelObject(ModelStages& stages, const std::vector<std::string>& session_ids, bool again,
                         base::JobControl& control);

struct LocalStagesOptions
{
  std::string object_id, name;
  RefinementOptions refinement;
  segmentation::ObjectMaskPropagatorOptions segmentation;
  std::optional<Eigen::Vector3d> seed_point_session;  ///< names the object in every session that is segmented
  AlignOptions align;
  BuildOptions build;  ///< left_out is set by what was aligned
  std::vector<std::string> violations() const;
};

/// The stages on a store and a database of this process.
class LocalStages : public ModelStages
{
public:
  /// Both must outlive this.
  LocalStages(keyframes::SessionStore& store, database::ObjectDatabase& database, LocalStagesOptions options);
  keyframes::Session session(const std::string& session_id) override;
  void refine(const std::vector<std::string>& session_ids, base::JobControl& control) override;
  void segment(const std::vector<std::string>& session_ids, base::JobControl& control) override;
  AlignedSessions align(const std::vector<std::string>& session_ids, base::JobControl& control) override;
  base::Status build(const AlignedSessions& aligned, base::JobControl& control) override;

protected:
  /// Told of what was made, also of what failed.
  virtual void onRefined(const std::string& /*session_id*/, const SessionRefinement& /*refined*/) {}
  virtual void onSegmented(const SegmentReport& /*segmented*/) {}
  virtual void onAligned(const alignment::AlignmentResult& /*aligned*/) {}
  virtual void onBuilt(const BuildReport& /*built*/) {}

private:
  keyframes::SessionStore& store_;
  database::ObjectDatabase& database_;
  LocalStagesOptions options_;
};

}  // namespace object_modelling::pipeline
