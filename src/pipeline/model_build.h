#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "build_views.h"
#include "object_modelling/pipeline/build_object.h"

namespace object_modelling::pipeline
{
/// Makes the report in an object's folder. A model without it is kept: returns the warning for the user.
std::string reportWarning(const std::string& folder, const std::string& object_id, const std::string& database_root,
                          base::JobControl& control);

class StageTimer
{
public:
  explicit StageTimer(std::vector<StageTime>* stages) : stages_(stages) {}
  /// The time since the last stage; a stage of that name gets it added.
  void finish(const std::string& stage);

private:
  std::vector<StageTime>* stages_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What a model is made of.
struct BuildInput
{
  std::string object_id, name;
  Views views;
  std::vector<alignment::SessionPlacement> placements;  ///< of the sessions of `views`, in this order
  std::optional<database::ObjectEntry> existing;        ///< of this id
  std::optional<Eigen::Isometry3d> T_model_reference;   ///< where the frame is known; else it is found
};

/// One build from loaded views, step by step; each step's status ends it unless OK.
class ModelBuild
{
public:
  /// The time of loading begins here. All must outlive this.
  ModelBuild(database::ObjectDatabase& database, const BuildOptions& options, base::JobControl& control)
      : database_(database), options_(options), control_(control)
  {
  }
  /// Once.
  BuildReport run(BuildInput input);
  const database::ObjectModel& model() const { return model_; }

private:
  base::Status fuse();
  base::Status chooseFrame();  ///< of an object that exists: its frame stays, or the build says that it does not
  base::Status reconstruct();  ///< the surface, and with it the frame of a new object
  void addTexture();
  void findSimilar();  ///< to a new object, in the database
  void addProperties();
  void completeModel();
  void addWarnings();  ///< to the status' message
  void write();

  database::ObjectDatabase& database_;
  const BuildOptions& options_;
  base::JobControl& control_;
  BuildReport report_;
  StageTimer timer_{ &report_.stages };
  BuildInput input_;
  geometry::OrientedBox box_reference_;
  fusion::CloudFusionResult fused_;
  texture::TextureResult texture_;
  report::ModelIdentity identity_;
  std::vector<std::string> warnings_;  ///< the model is kept; reported to the user; empty ones are skipped
  database::ObjectModel model_;
};

}  // namespace object_modelling::pipeline
