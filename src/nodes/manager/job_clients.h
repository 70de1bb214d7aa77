#pragma once

#include <object_modelling/AlignAction.h>
#include <object_modelling/BuildAction.h>
#include <object_modelling/RefineAction.h>
#include <object_modelling/SegmentSessionAction.h>

#include "action_caller.h"
#include "manager_options.h"

namespace object_modelling::nodes
{
/// The long jobs of the other nodes, of which one runs at a time.
class JobClients
{
public:
  JobClients(ros::NodeHandle& node, const ManagerOptions& options);

  ActionCaller<object_modelling::RefineAction> refine;
  ActionCaller<object_modelling::SegmentSessionAction> segment;
  ActionCaller<object_modelling::AlignAction> align;
  ActionCaller<object_modelling::BuildAction> build;

private:
  void connect();

  ros::WallTimer connect_timer_;  ///< until there is a time
};

}  // namespace object_modelling::nodes
