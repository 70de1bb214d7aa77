#pragma once

#include <string>
#include <vector>

#include "../common/frame_parameters.h"
#include "../common/store_parameters.h"
#include "object_modelling/pipeline/build_object.h"

namespace object_modelling::nodes
{
struct ModelBuilderOptions
{
  std::string database_path;  ///< folder of the object database, made if it does not exist; see dataPath("objects")
  std::string session_frame_id = "session";  ///< of the previews: the model is shown where the object stood
  pipeline::BuildOptions build;              ///< `replace` comes with each goal
  ros_bridge::RemoteSessionStoreOptions store;

  std::vector<std::string> violations() const
  {
    base::OptionsCheck check("model_builder");
    requireFrameId(check, "session_frame_id", session_frame_id);
    check.include(build.violations());
    return check.violations();
  }
};

template <typename Reader>
void read(Reader& reader, ModelBuilderOptions* options)
{
  reader.read("database_path", options->database_path);
  reader.read("session_frame_id", options->session_frame_id);
  reader.read("fusion/resolution_m", options->build.fusion.resolution_m);
  reader.read("fusion/averaging_radius_m", options->build.fusion.averaging_radius_m);
  reader.read("fusion/min_weight", options->build.fusion.min_weight);
  reader.read("fusion/consistency_sigmas", options->build.fusion.consistency_sigmas);
  reader.read("fusion/min_views", options->build.fusion.min_views);
  reader.read("fusion/weight/model", options->build.fusion.weight.model,
              { { "paper", rgbd::WeightModel::PAPER },
                { "paper_printed", rgbd::WeightModel::PAPER_PRINTED },
                { "nguyen", rgbd::WeightModel::NGUYEN } });
  reader.read("fusion/weight/theta_max_rad", options->build.fusion.weight.theta_max_rad);
  reader.read("fusion/weight/sigma_lateral_m", options->build.fusion.weight.sigma_lateral_m);
  reader.read("surface/resolution_m", options->build.surface.resolution_m);
  reader.read("surface/max_support_distance_m", options->build.surface.max_support_distance_m);
  reader.read("surface/watertight", options->build.surface.watertight);
  reader.read("surface/max_triangles", options->build.surface.max_triangles);
  reader.read("surface/max_decimation_error_m", options->build.surface.max_decimation_error_m);
  reader.read("texture/texel_size_m", options->build.texture.texel_size_m);
  reader.read("texture/max_atlas_px", options->build.texture.max_atlas_px);
  reader.read("texture/padding_px", options->build.texture.padding_px);
  reader.read("texture/view_preference", options->build.texture.view_preference);
  reader.read("texture/outlier_tolerance", options->build.texture.outlier_tolerance);
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
