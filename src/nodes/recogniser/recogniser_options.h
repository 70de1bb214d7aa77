#pragma once

#include <string>
#include <vector>

#include "../common/frame_parameters.h"
#include "object_modelling/recognition/recogniser.h"

namespace object_modelling::nodes
{
struct RecogniserNodeOptions
{
  std::string database_path;     ///< folder of the object database; see dataPath("objects")
  double rate_hz = 0;            ///< of ~detections without a call; 0: on request only
  double input_timeout_s = 5.0;  ///< how long ~recognise waits for a first frame, by the wall clock
  double poll_period_s = 1.0;    ///< between two looks at the database
  rgbd::FrameBuilderOptions frame;
  recognition::RecogniserOptions recogniser;

  std::vector<std::string> violations() const;
};

template <typename Reader>
void read(Reader& reader, RecogniserNodeOptions* options)
{
  reader.read("database_path", options->database_path);
  reader.read("rate_hz", options->rate_hz);
  reader.read("input_timeout_s", options->input_timeout_s);
  reader.read("poll_period_s", options->poll_period_s);
  read(reader, &options->frame);
  recognition::RecogniserOptions& recogniser = options->recogniser;
  reader.read("recogniser/min_confidence_ratio", recogniser.min_confidence_ratio);
  reader.read("recogniser/max_distance_m", recogniser.max_distance_m);
  reader.read("recogniser/min_visible_ratio", recogniser.min_visible_ratio);
  reader.read("recogniser/max_features", recogniser.max_features);
  reader.read("recogniser/use_texture", recogniser.use_texture);
  reader.read("recogniser/use_shape", recogniser.use_shape);
  reader.read("recogniser/reference_points", recogniser.reference_points);
  reader.read("recogniser/max_scene_points", recogniser.max_scene_points);
  reader.read("recogniser/objects_per_cluster", recogniser.objects_per_cluster);
  reader.read("recogniser/time_budget_s", recogniser.time_budget_s);
  reader.read("recogniser/hypotheses_per_cluster", recogniser.hypotheses_per_cluster);
  reader.read("recogniser/seed", recogniser.seed);
}

}  // namespace object_modelling::nodes
