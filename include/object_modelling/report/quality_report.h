#pragma once

#include <string>
#include <vector>

#include "object_modelling/database/object_model.h"
#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/keyframes/session.h"
#include "object_modelling/surface/surface_reconstruction.h"
#include "object_modelling/texture/texturing.h"

namespace object_modelling::report
{
/// Where a view of the model comes from.
struct ViewOrigin
{
  std::string session_id;
  int keyframe_id = -1;
};

/// Time that one stage took.
struct StageTime
{
  std::string stage;
  double duration_s = 0;
};

/// Options of the stages that a model was made by.
struct ModelOptions
{
  fusion::CloudFusionOptions fusion;
  surface::SurfaceOptions surface;
  texture::TextureOptions texture;
};

/// How the object frame of a model was found.
struct FrameOrigin
{
  /// "first": the object is new; "session": by a session that the stored model has, too; "alignment": of the new model
  /// with the stored one; "new": that was not certain, and the frame is another one.
  std::string by = "first";
  double probability = 1;  ///< of the alignment
};

/// An object of the database that a new one looks like.
struct SimilarObject
{
  std::string object_id;
  double probability = 0;  ///< that both are the same object
};

/// What a model is against those that were there.
struct ModelIdentity
{
  FrameOrigin frame;
  std::vector<SimilarObject> looks_like;  ///< most probable first
  std::vector<std::string> warnings;      ///< of the build, for people
};

/// Text of quality.yaml (docs/report.md) of a model that is complete but for it. `origins`: one per view.
std::string qualityYaml(const database::ObjectModel& model, const std::vector<keyframes::Session>& sessions,
                        const std::vector<ViewOrigin>& origins, const ModelOptions& options,
                        const ModelIdentity& identity, const std::vector<StageTime>& stages);

}  // namespace object_modelling::report
