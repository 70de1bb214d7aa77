#pragma once

#include <string>

#include <ros/node_handle.h>

#include "object_modelling/base/job_control.h"

namespace object_modelling::nodes
{
/// Latched ~progress of a node that runs one job at a time. Not thread safe.
class ProgressPublisher
{
public:
  explicit ProgressPublisher(ros::NodeHandle& private_node);

  void begin(const std::string& job);
  /// False if nothing was published because the last report is too recent; changes of stage and its end always are.
  bool report(const base::Progress& progress);
  void end(const base::Status& status);

private:
  void publish(const base::Progress& progress, bool active, const base::Status& status);

  ros::Publisher publisher_;
  std::string job_;
  base::Progress last_;
  ros::WallTime last_time_;
};

}  // namespace object_modelling::nodes
