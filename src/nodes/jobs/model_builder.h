#pragma once

#include <object_modelling/BuildAction.h>
#include <object_modelling/ListObjects.h>

#include "../common/job_server.h"
#include "model_builder_options.h"
#include "model_preview.h"

namespace object_modelling::nodes
{
/// Node model_builder: action ~build, service ~list_objects, previews ~model and ~model_mesh. The database is opened
/// for every call: a folder that cannot be used is a Status, not the end of the node, and works once it has been
/// mended.
class ModelBuilder
{
public:
  ModelBuilder(ros::NodeHandle& node, ros::NodeHandle& private_node, const ModelBuilderOptions& options);
  ~ModelBuilder();

private:
  object_modelling::BuildResult build(const object_modelling::BuildGoal& goal, base::JobControl& control);
  bool listObjects(object_modelling::ListObjects::Request& request, object_modelling::ListObjects::Response& response);

  ModelBuilderOptions options_;
  std::string database_path_;
  ros_bridge::RemoteSessionStore store_;
  ModelPreview preview_;
  ros::ServiceServer list_objects_;
  JobServer<object_modelling::BuildAction> server_;
};

}  // namespace object_modelling::nodes
