#pragma once

#include <string>
#include <vector>

#include "../common/frame_parameters.h"
#include "../common/store_parameters.h"
#include "object_modelling/rgbd/frame_builder.h"
#include "object_modelling/segmentation/object_mask_propagator.h"

namespace object_modelling::nodes
{
struct SegmenterOptions
{
  bool automatic = true;             ///< without a choice of the user, choose in the first keyframe of a session
  double preview_rate_hz = 1.0;      ///< of ~hypotheses while somebody listens; 0: only on request
  double selection_margin_m = 0.05;  ///< a point this far from a hypothesis still selects it
  double tf_timeout_s = 0.2;         ///< how long to wait for the session frame at the stamp of a frame
  std::string session_frame_id = "session";
  rgbd::FrameBuilderOptions frame;
  segmentation::ObjectMaskPropagatorOptions propagator;
  ros_bridge::RemoteSessionStoreOptions store;

  std::vector<std::string> violations() const;
};

template <typename Reader>
void read(Reader& reader, SegmenterOptions* options)
{
  reader.read("automatic", options->automatic);
  reader.read("preview_rate_hz", options->preview_rate_hz);
  reader.read("selection_margin_m", options->selection_margin_m);
  reader.read("tf_timeout_s", options->tf_timeout_s);
  reader.read("session_frame_id", options->session_frame_id);
  read(reader, &options->frame);
  segmentation::SceneSegmenterOptions& scene = options->propagator.segmenter;
  reader.read("scene/plane_angle_rad", scene.plane_angle_rad);
  reader.read("scene/plane_distance_sigmas", scene.plane_distance_sigmas);
  reader.read("scene/min_plane_ratio", scene.min_plane_ratio);
  reader.read("scene/min_height_m", scene.min_height_m);
  reader.read("scene/height_noise_sigmas", scene.height_noise_sigmas);
  reader.read("scene/max_height_m", scene.max_height_m);
  reader.read("scene/max_distance_m", scene.max_distance_m);
  reader.read("scene/cluster_depth_step_ratio", scene.cluster_depth_step_ratio);
  reader.read("scene/min_cluster_px", scene.min_cluster_px);
  reader.read("propagator/voxel_size_m", options->propagator.voxel_size_m);
  reader.read("propagator/min_cluster_overlap_ratio", options->propagator.min_cluster_overlap_ratio);
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
