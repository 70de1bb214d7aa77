#include "model_builder.h"

#include <filesystem>

#include "../common/data_path.h"
#include "left_out_message.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "placement_message.h"

namespace object_modelling::nodes
{
namespace
{
object_modelling::ObjectSummary toMessage(const database::ObjectEntry& entry)
{
  object_modelling::ObjectSummary message;
  message.object_id = entry.id;
  message.name = entry.name;
  message.size_m = ros_bridge::toVectorMessage(entry.size_m);
  message.diameter_m = entry.diameter_m;
  for (const database::ModelSession& session : entry.sessions)
    message.session_ids.push_back(session.id);
  message.content_hash = entry.content_hash;
  message.mesh_path = entry.mesh_path;
  message.partial = entry.partial;
  message.frame_version = static_cast<std::uint32_t>(entry.frame_version);
  message.aliases = entry.aliases;
  for (const database::LeftOutSession& session : entry.sessions_left_out)
    message.left_out.push_back(leftOutMessage(session));
  return message;
}

object_modelling::BuiltObject toMessage(const pipeline::BuildReport& report, const std::string& object_id)
{
  object_modelling::BuiltObject message;
  message.object_id = object_id;
  message.object_folder = report.object_folder;
  message.preview_path = report.preview_path;
  message.size_m = ros_bridge::toVectorMessage(report.size_m);
  message.diameter_m = report.diameter_m;
  message.point_count = report.point_count;
  message.vertex_count = report.vertex_count;
  message.triangle_count = report.triangle_count;
  message.frame_version = static_cast<std::uint32_t>(report.frame_version);
  message.frame_by = report.frame.by;
  message.frame_probability = report.frame.probability;
  for (const report::SimilarObject& similar : report.looks_like)
  {
    message.looks_like.emplace_back();
    message.looks_like.back().object_id = similar.object_id;
    message.looks_like.back().probability = similar.probability;
  }
  for (const pipeline::StageTime& time : report.stages)
  {
    message.stages.emplace_back();
    message.stages.back().stage = time.stage;
    message.stages.back().duration_s = time.duration_s;
  }
  return message;
}
}  // namespace

ModelBuilder::ModelBuilder(ros::NodeHandle& node, ros::NodeHandle& private_node, const ModelBuilderOptions& options)
    : options_(options),
      database_path_(dataPath(options.database_path, "objects")),
      store_(node, options.store),
      preview_(private_node, options.session_frame_id),
      list_objects_(private_node.advertiseService("list_objects", &ModelBuilder::listObjects, this)),
      server_(
          private_node, "build", [](const object_modelling::BuildGoal& goal) { return "build " + goal.object_id; },
          [this](const object_modelling::BuildGoal& goal, base::JobControl& control) { return build(goal, control); })
{
}

// The action server is taken down here: its templates cost the compiler seconds wherever they are seen.
ModelBuilder::~ModelBuilder() = default;

object_modelling::BuildResult ModelBuilder::build(const object_modelling::BuildGoal& goal, base::JobControl& control)
{
  const std::vector<alignment::SessionPlacement> placements = placementsFrom(goal.placements);
  // Before the long work: a folder that cannot be written is known at once.
  database::ObjectDatabase database(database_path_, true);
  pipeline::BuildOptions build_options = options_.build;
  build_options.replace = goal.replace;
  for (const object_modelling::SessionLeftOut& session : goal.left_out)
    build_options.left_out.push_back(leftOutFrom(session));
  const pipeline::BuildReport report =
      pipeline::buildObject(store_, database, goal.object_id, goal.name, placements, build_options, control);
  object_modelling::BuildResult result;
  result.status = ros_bridge::toMessage(report.status);
  if (!report.status.ok())
    return result;
  result.built = toMessage(report, goal.object_id);
  result.built.partial = !goal.left_out.empty();
  result.built.left_out = goal.left_out;
  const database::ObjectEntry entry = database.entry(goal.object_id);
  result.built.mesh_path = entry.mesh_path;
  const base::Status shown = ros_bridge::guarded([&] { preview_.show(entry, placements.back().session_id); });
  if (!shown.ok())
    ROS_WARN("'%s' is built, but its preview cannot be shown: %s", goal.object_id.c_str(), shown.message.c_str());
  return result;
}

bool ModelBuilder::listObjects(object_modelling::ListObjects::Request&,
                               object_modelling::ListObjects::Response& response)
{
  return ros_bridge::answer(
      response,
      [&]
      {
        response.database_path = database_path_;
        if (!std::filesystem::exists(database_path_))
          return;  // made by the first build
        for (const database::ObjectEntry& entry : database::ObjectDatabase(database_path_, false).list())
          response.objects.push_back(toMessage(entry));
      });
}

}  // namespace object_modelling::nodes
