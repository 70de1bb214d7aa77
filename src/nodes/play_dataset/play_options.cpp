#include "play_options.h"

#include <CLI/CLI.hpp>

namespace object_modelling::nodes
{
namespace
{
constexpr int USAGE_ERROR = 2;

constexpr char DESCRIPTION[] =
    "Publishes a recording (a TUM-style folder or a ROS bag) as a camera driver would: rgb/image_rect_color,\n"
    "depth_registered/image_rect, rgb/camera_info and, if it has masks, object_mask, all with the recording's own "
    "stamps.\n"
    "Distorted images are rectified first. Names are relative: play_dataset FOLDER __ns:=camera";
constexpr char FOOTER[] =
    "Exit codes: 0 played to the end (or ended by Ctrl-C), 1 the recording cannot be played or nobody answers, 2 wrong "
    "usage.";
}  // namespace

bool parseCommandLine(int argc, char** argv, PlayOptions* options, int* exit_code)
{
  CLI::App app(DESCRIPTION, "play_dataset");
  app.footer(FOOTER);
  app.option_defaults()->always_capture_default();
  app.add_option("recording", options->recording, "folder with rgb.txt, depth.txt and camera.yaml, or a .bag file")
      ->required();
  CLI::Option* rate =
      app.add_option("--rate", options->rate_ratio, "speed, 1: as recorded")->check(CLI::Range(0.001, 1000.0));
  app.add_flag("--lossless", options->lossless,
               "send each frame when the camera tracker has answered for the one before, as fast as it goes")
      ->excludes(rate);
  app.add_flag("--loop", options->loop, "begin again at the end, with stamps that go on");
  app.add_option("--wait", options->wait_s, "seconds to wait for a listener before the first frame")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--answer-timeout", options->answer_timeout_s,
                 "lossless: seconds that the tracker may take for one frame")
      ->check(CLI::Range(0.1, 3600.0));
  app.add_option("--tracker-state", options->tracker_state, "lossless: topic of the tracker's state");
  app.add_option("--max-stamp-difference", options->source.bag.max_stamp_difference_s,
                 "seconds between colour and depth of one frame")
      ->check(CLI::PositiveNumber);
  ros_bridge::BagTopics& topics = options->source.bag.topics;
  const char* group = "Topics in a bag (found by themselves where only one fits)";
  app.add_option("--color-topic", topics.color, "sensor_msgs/Image, rectified if its name has \"rect\"")->group(group);
  app.add_option("--depth-topic", topics.depth, "sensor_msgs/Image, registered to colour")->group(group);
  app.add_option("--camera-info-topic", topics.camera_info, "sensor_msgs/CameraInfo of colour")->group(group);
  app.add_option("--mask-topic", topics.object_mask, "sensor_msgs/Image, mono8")->group(group);
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error)
  {
    *exit_code = app.exit(error) == 0 ? 0 : USAGE_ERROR;
    return false;
  }
  options->source.folder.max_stamp_difference_s = options->source.bag.max_stamp_difference_s;
  return true;
}

}  // namespace object_modelling::nodes
