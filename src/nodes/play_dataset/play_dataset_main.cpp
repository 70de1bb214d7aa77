#include <iostream>

#include <ros/ros.h>

#include "object_modelling/ros_bridge/ros_log_sink.h"
#include "player.h"

int main(int argc, char** argv)
{
  using namespace object_modelling;
  ros::init(argc, argv, "play_dataset", ros::init_options::AnonymousName);
  nodes::PlayOptions options;
  int exit_code = 0;
  if (!nodes::parseCommandLine(argc, argv, &options, &exit_code))
    return exit_code;
  try
  {
    ros::NodeHandle node;
    const ros_bridge::RosLogSink log_sink;
    ros::AsyncSpinner spinner(1);
    spinner.start();
    nodes::Player player(node, options);
    std::cout << player.play() << std::endl;
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << "play_dataset: " << error.what() << std::endl;
    return 1;
  }
}
