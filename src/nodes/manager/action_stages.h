#pragma once

#include <functional>
#include <string>
#include <vector>

#include <object_modelling/BuildObject.h>

#include "job_clients.h"
#include "object_modelling/pipeline/model_object.h"

namespace object_modelling::nodes
{
/// The stages of one object, done by the other nodes. The message of what failed begins with its stage.
class ActionStages : public pipeline::ModelStages
{
public:
  using OnStage = std::function<void(const std::string& stage)>;

  /// `jobs` and `store` must outlive this.
  ActionStages(JobClients& jobs, keyframes::SessionStore& store, const object_modelling::BuildObject::Request& request,
               OnStage on_stage);
  keyframes::Session session(const std::string& session_id) override { return store_.session(session_id); }
  void refine(const std::vector<std::string>& session_ids, base::JobControl& control) override;
  void segment(const std::vector<std::string>& session_ids, base::JobControl& control) override;
  pipeline::AlignedSessions align(const std::vector<std::string>& session_ids, base::JobControl& control) override;
  base::Status build(const pipeline::AlignedSessions& aligned, base::JobControl& control) override;
  void onStage(const std::string& stage) override { on_stage_(stage); }

  /// What the last build() made.
  const object_modelling::BuiltObject& built() const { return built_; }

private:
  JobClients& jobs_;
  keyframes::SessionStore& store_;
  object_modelling::BuildObject::Request request_;
  OnStage on_stage_;
  object_modelling::BuiltObject built_;
};

}  // namespace object_modelling::nodes
