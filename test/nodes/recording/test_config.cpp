#include <gtest/gtest.h>

#include "nodes/camera_tracker/camera_tracker_options.h"
#include "nodes/common/data_path.h"
#include "nodes/common/run_node.h"
#include "nodes/keyframe_store/keyframe_store_options.h"
#include "yaml_parameters.h"

// config/<node>.yaml is read by the node's own loader, holds every key, and says what the options' defaults say.
namespace object_modelling::nodes
{
namespace
{
std::string textOf(const XmlRpc::XmlRpcValue& value)
{
  std::ostringstream text;
  XmlRpc::XmlRpcValue copy = value;
  if (copy.getType() == XmlRpc::XmlRpcValue::TypeInt)
    text << static_cast<double>(static_cast<int>(copy));
  else if (copy.getType() == XmlRpc::XmlRpcValue::TypeDouble)
    text << static_cast<double>(copy);
  else
    copy.write(text);
  return text.str();
}

template <typename Options>
void expectDefaults(const std::string& node)
{
  const XmlRpc::XmlRpcValue yaml = test::loadYaml(std::string(OBJECT_MODELLING_CONFIG) + "/" + node + ".yaml");
  ros_bridge::ParamReader reader(node, yaml);
  optionsFrom<Options>(reader);
  EXPECT_NO_THROW(reader.finish());

  Options defaults;
  test::FieldList known;
  read(known, &defaults);
  std::map<std::string, std::string> expected, shipped;
  for (const auto& [key, value] : known.fields)
    expected[key] = textOf(value);
  for (const auto& [key, value] : test::leaves(yaml))
    shipped[key] = textOf(value);
  EXPECT_EQ(expected, shipped);
}

TEST(RecordingConfig, CameraTracker)
{
  expectDefaults<CameraTrackerNodeOptions>("camera_tracker");
}
TEST(RecordingConfig, KeyframeStore)
{
  expectDefaults<KeyframeStoreOptions>("keyframe_store");
}

TEST(RecordingConfig, DataPath)
{
  ::setenv("HOME", "/home/someone", 1);
  ::unsetenv("ROS_HOME");
  EXPECT_EQ("/home/someone/.ros/object_modelling/keyframes.sqlite", dataPath("", "keyframes.sqlite"));
  EXPECT_EQ("/home/someone/a.sqlite", dataPath("~/a.sqlite", "keyframes.sqlite"));
  EXPECT_EQ("postgresql://u@h/db", dataPath("postgresql://u@h/db", "keyframes.sqlite"));
  ::setenv("ROS_HOME", "/var/ros", 1);
  EXPECT_EQ("/var/ros/object_modelling/keyframes.sqlite", dataPath("", "keyframes.sqlite"));
}
}  // namespace
}  // namespace object_modelling::nodes
