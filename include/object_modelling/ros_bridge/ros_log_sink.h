#pragma once

#include <glog/logging.h>

namespace object_modelling::ros_bridge
{
/// While it lives, messages that the libraries log by glog go to rosconsole (and so to /rosout) instead of stderr and
/// files. One per process; made by main after ros::init.
class RosLogSink : public google::LogSink
{
public:
  RosLogSink();
  ~RosLogSink() override;

  using google::LogSink::send;
  void send(google::LogSeverity severity, const char* full_filename, const char* base_filename, int line,
            const struct ::tm* tm_time, const char* message, std::size_t message_len) override;
};

}  // namespace object_modelling::ros_bridge
