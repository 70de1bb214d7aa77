#include <gtest/gtest.h>

#include "nodes/camera_tracker/input_watch.h"

namespace object_modelling::nodes
{
namespace
{
bool names(const std::string& text, const std::string& what)
{
  return text.find(what) != std::string::npos;
}

TEST(InputWatch, NamesTheSilentTopics)
{
  const ros::WallTime start(100);
  InputWatch watch(3, start);
  const std::size_t color = watch.add("/color");
  const std::size_t info = watch.add("/info");
  EXPECT_EQ("", watch.silentTopics(ros::WallTime(102)));
  watch.heard(color, ros::WallTime(103));
  std::string text = watch.silentTopics(ros::WallTime(104));
  EXPECT_TRUE(names(text, "/info yet")) << text;
  EXPECT_FALSE(names(text, "/color")) << text;
  watch.heard(info, ros::WallTime(104));
  EXPECT_EQ("", watch.silentTopics(ros::WallTime(105)));
  text = watch.silentTopics(ros::WallTime(110));
  EXPECT_TRUE(names(text, "/color, /info any more")) << text;
}

TEST(InputWatch, FramesMakeSilenceHarmless)
{
  InputWatch watch(3, ros::WallTime(100));
  EXPECT_TRUE(watch.framesCome(ros::WallTime(102)));
  EXPECT_FALSE(watch.framesCome(ros::WallTime(104)));
  watch.gotFrame(ros::WallTime(104));
  EXPECT_TRUE(watch.framesCome(ros::WallTime(106)));
}
}  // namespace
}  // namespace object_modelling::nodes
