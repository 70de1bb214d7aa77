#pragma once

#include <exception>
#include <string>

#include <ros/ros.h>

#include "object_modelling/ros_bridge/param_reader.h"
#include "object_modelling/ros_bridge/ros_log_sink.h"

namespace object_modelling::nodes
{
/// What main of a node does: reads the parameters, makes the node and spins. Returns the exit code; what is wrong with
/// the parameters is logged.
template <typename Node, typename Options>
int runNode(int argc, char** argv, const std::string& name, Options (*read_options)(ros_bridge::ParamReader&))
{
  ros::init(argc, argv, name);
  // Outside the try block: with its last handle a node shuts down, and nothing is logged any more.
  ros::NodeHandle node;
  ros::NodeHandle private_node("~");
  try
  {
    const ros_bridge::RosLogSink log_sink;
    ros_bridge::ParamReader reader(private_node);
    const Options options = read_options(reader);
    reader.finish();
    const Node running(node, private_node, options);
    ROS_INFO("ready");
    ros::spin();
    return 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}

/// A `read_options` for options with a function read(Reader&, Options*) beside them. Where that is a template, tests
/// can list the keys.
template <typename Options>
Options optionsFrom(ros_bridge::ParamReader& reader)
{
  Options options;
  read(reader, &options);
  reader.include(options.violations());
  return options;
}

}  // namespace object_modelling::nodes
