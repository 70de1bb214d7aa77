#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/job_control.h"
#include "object_modelling/keyframes/session.h"
#include "object_modelling/registration/partial_model.h"
#include "object_modelling/rgbd/keyframe.h"

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

}  // namespace object_modelling::alignment
