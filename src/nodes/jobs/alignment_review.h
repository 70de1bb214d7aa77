#pragma once

#include <mutex>
#include <optional>

#include <geometry_msgs/PointStamped.h>
#include <object_modelling/AcceptAlignment.h>
#include <object_modelling/AlignByPoints.h>
#include <object_modelling/ForgetAlignment.h>
#include <object_modelling/RefuseAlignment.h>
#include <object_modelling/ShowAlignment.h>

#include "alignment_display.h"
#include "session_aligner_options.h"

namespace object_modelling::nodes
{
/// A person's view of what was found for two sessions, and a person's decisions: services ~accept, ~refuse, ~forget,
/// ~align_by_points and ~show, the display, and points clicked in it.
class AlignmentReview
{
public:
  /// `store` must outlive this.
  AlignmentReview(ros::NodeHandle& node, ros::NodeHandle& private_node, ros_bridge::RemoteSessionStore& store,
                  const SessionAlignerOptions& options);

  /// Shows the first pair that was refused; where none was, the first.
  void show(const std::vector<alignment::AlignmentEdge>& edges, std::vector<registration::PartialModel> parts);

private:
  template <typename Service>
  void serve(ros::NodeHandle& node, const std::string& name,
             void (AlignmentReview::*handler)(const typename Service::Request&, typename Service::Response&));
  void accept(const AcceptAlignment::Request& request, AcceptAlignment::Response& response);
  void refuse(const RefuseAlignment::Request& request, RefuseAlignment::Response& response);
  void forget(const ForgetAlignment::Request& request, ForgetAlignment::Response& response);
  void alignByPoints(const AlignByPoints::Request& request, AlignByPoints::Response& response);
  void showPair(const ShowAlignment::Request& request, ShowAlignment::Response& response);
  void onClickedPoint(const geometry_msgs::PointStampedConstPtr& point);

  /// The calls below need mutex_.
  AlignmentScene::PartPointer part(const std::string& session_id);
  void display(const alignment::AlignmentEdge& edge);
  void refreshIfShown(const alignment::AlignmentEdge& edge);
  void click(const AlignmentScene::Spot& spot);

  SessionAlignerOptions options_;
  ros_bridge::RemoteSessionStore& store_;
  std::mutex mutex_;  ///< guards all below: jobs show what they found from a thread of their own
  AlignmentDisplay display_;
  std::optional<AlignmentScene> scene_;
  std::vector<AlignmentScene::PartPointer> parts_;  ///< of the pair that is shown
  std::vector<AlignmentScene::Spot> clicks_;
  std::vector<ros::ServiceServer> servers_;
  ros::Subscriber clicked_point_;
};

}  // namespace object_modelling::nodes
