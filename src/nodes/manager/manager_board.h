#pragma once

#include <mutex>
#include <string>

#include <object_modelling/BuiltObject.h>
#include <object_modelling/ManagerState.h>
#include <ros/node_handle.h>

#include "modelling_state.h"
#include "object_modelling/base/job_control.h"

namespace object_modelling::nodes
{
/// What the services of the manager share: its state, and what it publishes of it, ~state and ~progress, both latched.
class ManagerBoard
{
public:
  explicit ManagerBoard(ros::NodeHandle& private_node);

  /// Held for the whole of a call that begins or ends something: such calls are taken one after the other.
  std::mutex commands;
  /// Guards all below but progress(); never held while another node is called.
  std::mutex mutex;
  ModellingState state;

  /// Outcomes of calls and jobs; each publishes ~state.
  void succeeded(const std::string& note = "");
  void failed(const base::Status& status);
  void publishState();
  /// What the last build made, from the next ~state on.
  void setBuilt(const object_modelling::BuiltObject& built) { built_ = built; }

  /// Of the build of an object. One thread at a time; what was published last is not published again.
  void progress(const std::string& object_id, const base::Progress& progress);
  void finished(const std::string& object_id, const base::Status& status);

private:
  ros::Publisher state_publisher_, progress_publisher_;
  base::Status status_;
  object_modelling::BuiltObject built_;
  std::string last_object_id_;  ///< of the progress; empty: none was published since the last end
  base::Progress last_progress_;
};

}  // namespace object_modelling::nodes
