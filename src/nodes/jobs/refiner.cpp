#include "refiner.h"

#include "object_modelling/pipeline/session_refinement.h"
#include "object_modelling/ros_bridge/pose_conversion.h"
#include "session_list.h"

namespace object_modelling::nodes
{
namespace
{
object_modelling::KeyframeResidual toMessage(const bundle_adjustment::KeyframeResidual& residual)
{
  object_modelling::KeyframeResidual message;
  bundle_adjustment::forFields([](const char*, auto& to, const auto& from) { to = from; }, message, residual);
  return message;
}

object_modelling::KeyframeLink toMessage(const bundle_adjustment::KeyframeLink& link)
{
  object_modelling::KeyframeLink message;
  message.keyframe_a = link.keyframe_a;
  message.keyframe_b = link.keyframe_b;
  message.a_from_b = ros_bridge::toPoseMessage(link.T_a_b);
  message.inlier_count = link.inlier_count;
  message.translation_error_before_m = link.translation_error_before_m;
  message.translation_error_after_m = link.translation_error_after_m;
  message.rotation_error_before_rad = link.rotation_error_before_rad;
  message.rotation_error_after_rad = link.rotation_error_after_rad;
  return message;
}

void addBundle(const bundle_adjustment::BundleAdjustmentResult& result, object_modelling::SessionRefinement* message)
{
  message->iterations = result.iterations;
  message->initial_cost = result.initial_cost;
  message->final_cost = result.final_cost;
  message->color_offset_px = { result.color_offset_px.x(), result.color_offset_px.y() };
  for (const bundle_adjustment::KeyframeResidual& residual : result.residuals)
    message->residuals.push_back(toMessage(residual));
  for (const bundle_adjustment::KeyframeLink& link : result.links)
    message->links.push_back(toMessage(link));
  message->left_out.assign(result.left_out.begin(), result.left_out.end());
}

void addIcp(const multi_view_icp::MultiViewIcpResult& result, const std::vector<int>& keyframe_ids,
            object_modelling::SessionRefinement* message)
{
  message->icp_status = ros_bridge::toMessage(result.status);
  message->icp_iterations = result.iterations;
  message->icp_rmse_m = result.rmse_m;
  for (const int view : result.left_out)
    message->icp_left_out.push_back(keyframe_ids.at(view));
  for (std::size_t k = 0; k < result.residuals.size(); ++k)
  {
    const multi_view_icp::IcpViewResidual& residual = result.residuals[k];
    object_modelling::IcpResidual added;
    added.keyframe_id = keyframe_ids.at(k);
    added.point_count = residual.point_count;
    added.rmse_before_m = residual.rmse_before_m;
    added.rmse_after_m = residual.rmse_after_m;
    added.inlier_ratio = residual.inlier_ratio;
    for (const multi_view_icp::FreeDirection& free : result.free_directions)
      added.free_direction_count += free.view == static_cast<int>(k);
    message->icp_residuals.push_back(added);
  }
}

object_modelling::SessionRefinement toMessage(const std::string& session_id, const pipeline::SessionRefinement& refined)
{
  object_modelling::SessionRefinement message;
  message.session_id = session_id;
  message.status = ros_bridge::toMessage(refined.status);
  if (refined.bundle_adjustment)
    addBundle(*refined.bundle_adjustment, &message);
  if (refined.multi_view_icp)
    addIcp(*refined.multi_view_icp, refined.keyframe_ids, &message);
  return message;
}

pipeline::RefinementMethod methodOf(const object_modelling::RefineGoal& goal, const RefinerOptions& options)
{
  using object_modelling::RefineGoal;
  switch (goal.method)
  {
    case RefineGoal::DEFAULT:
      return pipeline::refinementMethodFrom(options.method);
    case RefineGoal::BUNDLE_ADJUSTMENT:
      return pipeline::RefinementMethod::BUNDLE_ADJUSTMENT;
    case RefineGoal::MULTI_VIEW_ICP:
      return pipeline::RefinementMethod::MULTI_VIEW_ICP;
    case RefineGoal::BOTH:
      return pipeline::RefinementMethod::BOTH;
    default:
      throw base::Error(base::StatusCode::INVALID_ARGUMENT,
                        "method " + std::to_string(goal.method) + " is not known: see the constants of RefineGoal");
  }
}
}  // namespace

Refiner::Refiner(ros::NodeHandle& node, ros::NodeHandle& private_node, const RefinerOptions& options)
    : options_(options),
      store_(node, options.store),
      server_(
          private_node, "refine",
          [](const object_modelling::RefineGoal& goal) { return "refine " + joined(goal.session_ids); },
          [this](const object_modelling::RefineGoal& goal, base::JobControl& control) { return refine(goal, control); })
{
}

// The action server is taken down here: its templates cost the compiler seconds wherever they are seen.
Refiner::~Refiner() = default;

object_modelling::RefineResult Refiner::refine(const object_modelling::RefineGoal& goal, base::JobControl& control)
{
  requireSessions(goal.session_ids);
  pipeline::RefinementOptions options = options_.refinement;
  options.method = methodOf(goal, options_);
  object_modelling::RefineResult result;
  for (const std::string& session_id : goal.session_ids)
  {
    pipeline::SessionRefinement refined;
    const base::Status thrown =
        ros_bridge::guarded([&] { refined = pipeline::refineSessionBy(store_, session_id, options, control); });
    if (!thrown.ok())
      refined.status = thrown;
    result.sessions.push_back(toMessage(session_id, refined));
    if (!refined.status.ok())
    {
      result.status = ros_bridge::toMessage(refined.status);
      break;
    }
  }
  return result;
}

}  // namespace object_modelling::nodes
