#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/fusion/cloud_fusion.h"
#include "object_modelling/keyframes/session.h"
#include "object_modelling/registration/partial_model.h"
#include "object_modelling/rgbd/keyframe.h"
#include "object_modelling/rgbd/view.h"

namespace object_modelling::alignment
{
struct PartialModelOptions
{
  double spacing_m = 0.002;  ///< of the points
  int max_points = 8000;     ///< a larger object gets wider spaced ones
  int max_views = 12;        ///< keyframes used for empty space and features, spread over the directions
  int max_features = 400;    ///< per view; 0: shape and colour of the surface alone
  bool use_color = true;
  std::vector<std::string> violations() const;
};

/// Fuses the masked keyframes of a session and prepares what alignment looks up. Throws base::Error
/// (FAILED_PRECONDITION) that names the session where there is no object in it.
registration::PartialModel makePartialModel(const keyframes::Session& session,
                                            const std::vector<rgbd::Keyframe>& keyframes,
                                            const PartialModelOptions& options, base::JobControl& control);

/// The same of a surface that is fused already, and of the views that show it: their world, the cloud's frame, is what
/// PartialModel calls the session frame. The spacing grows from `spacing_m` where the cloud has more than `max_points`.
/// Has no support plane. Throws base::Error (FAILED_PRECONDITION) that names `id` where there are too few points.
registration::PartialModel partOf(const std::string& id, const fusion::FusedCloud& cloud,
                                  const std::vector<rgbd::View>& views, const PartialModelOptions& options);

}  // namespace object_modelling::alignment
