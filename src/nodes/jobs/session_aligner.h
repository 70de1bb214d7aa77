#pragma once

#include <object_modelling/AlignAction.h>

#include "../common/job_server.h"
#include "alignment_review.h"

namespace object_modelling::nodes
{
/// Node session_aligner: action ~align, and what a person sees and decides (AlignmentReview).
class SessionAligner
{
public:
  SessionAligner(ros::NodeHandle& node, ros::NodeHandle& private_node, const SessionAlignerOptions& options);
  ~SessionAligner();

private:
  object_modelling::AlignResult align(const object_modelling::AlignGoal& goal, base::JobControl& control);
  alignment::AlignmentResult aligned(const object_modelling::AlignGoal& goal, base::JobControl& control);
  /// What a person can do so that the sessions left out take part.
  std::string remedyFor(const alignment::AlignmentResult& result) const;

  SessionAlignerOptions options_;
  std::string name_;  ///< of the node, in messages to people
  ros_bridge::RemoteSessionStore store_;
  AlignmentReview review_;
  JobServer<object_modelling::AlignAction> server_;
};

}  // namespace object_modelling::nodes
