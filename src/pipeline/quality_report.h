#pragma once

#include <map>
#include <string>
#include <vector>

#include "object_modelling/database/object_model.h"
#include "object_modelling/keyframes/session.h"
#include "object_modelling/pipeline/build_object.h"

namespace object_modelling::pipeline
{
/// Where a view of the model comes from.
struct ViewOrigin
{
  std::string session_id;
  int keyframe_id = -1;
};

/// Text of quality.yaml (docs/report.md) of a model that is complete but for it. `origins`: one per view.
std::string qualityYaml(const database::ObjectModel& model, const std::vector<keyframes::Session>& sessions,
                        const std::vector<ViewOrigin>& origins, const BuildOptions& options,
                        const std::vector<StageTime>& stages);

}  // namespace object_modelling::pipeline
