#pragma once

#include <object_modelling/RefineAction.h>

#include "../common/job_server.h"
#include "refiner_options.h"

namespace object_modelling::nodes
{
/// Node refiner: action ~refine.
class Refiner
{
public:
  Refiner(ros::NodeHandle& node, ros::NodeHandle& private_node, const RefinerOptions& options);
  ~Refiner();

private:
  object_modelling::RefineResult refine(const object_modelling::RefineGoal& goal, base::JobControl& control);

  RefinerOptions options_;
  ros_bridge::RemoteSessionStore store_;
  JobServer<object_modelling::RefineAction> server_;
};

}  // namespace object_modelling::nodes
