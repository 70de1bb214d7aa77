#include "object_modelling/ros_bridge/ros_log_sink.h"

#include <string>

#include <ros/console.h>

namespace object_modelling::ros_bridge
{
RosLogSink::RosLogSink()
{
  // Everything goes through this sink alone: no log files, nothing on stderr but what ends the process.
  for (google::LogSeverity severity = google::GLOG_INFO; severity < google::NUM_SEVERITIES; ++severity)
    google::SetLogDestination(severity, "");
  google::SetStderrLogging(google::GLOG_FATAL);
  google::InitGoogleLogging("object_modelling");
  google::AddLogSink(this);
}

RosLogSink::~RosLogSink()
{
  google::RemoveLogSink(this);
  google::ShutdownGoogleLogging();
}

void RosLogSink::send(google::LogSeverity severity, const char*, const char* base_filename, int line,
                      const struct ::tm*, const char* message, std::size_t message_len)
{
  const std::string text(message, message_len);
  if (severity == google::GLOG_INFO)
    ROS_INFO("%s [%s:%d]", text.c_str(), base_filename, line);
  else if (severity == google::GLOG_WARNING)
    ROS_WARN("%s [%s:%d]", text.c_str(), base_filename, line);
  else if (severity == google::GLOG_ERROR)
    ROS_ERROR("%s [%s:%d]", text.c_str(), base_filename, line);
  else
    ROS_FATAL("%s [%s:%d]", text.c_str(), base_filename, line);
}

}  // namespace object_modelling::ros_bridge
