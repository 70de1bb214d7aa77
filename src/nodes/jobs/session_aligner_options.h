#pragma once

#include <string>
#include <vector>

#include "../common/frame_parameters.h"
#include "../common/store_parameters.h"
#include "object_modelling/base/options.h"
#include "object_modelling/pipeline/align_sessions.h"

namespace object_modelling::nodes
{
struct SessionAlignerOptions
{
  pipeline::AlignOptions align;
  std::string display_frame_id = "alignment";
  ros_bridge::RemoteSessionStoreOptions store;

  std::vector<std::string> violations() const
  {
    base::OptionsCheck check("session_aligner");
    check.include(align.violations());
    requireFrameId(check, "display_frame_id", display_frame_id);
    return check.violations();
  }
};

template <typename Reader>
void read(Reader& reader, SessionAlignerOptions* options)
{
  alignment::PartialModelOptions& part = options->align.part;
  reader.read("part/spacing_m", part.spacing_m);
  reader.read("part/max_points", part.max_points);
  reader.read("part/max_views", part.max_views);
  reader.read("part/max_features", part.max_features);
  reader.read("part/use_color", part.use_color);
  alignment::PairAlignmentOptions& pair = options->align.pair;
  reader.read("pair/rotations", pair.rotations);
  reader.read("pair/refined_candidates", pair.refined_candidates);
  reader.read("pair/min_overlap_ratio", pair.min_overlap_ratio);
  reader.read("pair/min_probability", pair.min_probability);
  reader.read("pair/same_pose_probability", pair.same_pose_probability);
  reader.read("pair/seed", pair.seed);
  reader.read("pair/threads", pair.threads);
  reader.read("use_known", options->align.use_known);
  reader.read("display_frame_id", options->display_frame_id);
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
