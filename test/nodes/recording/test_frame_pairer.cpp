#include <gtest/gtest.h>

#include "nodes/camera_tracker/newest_slot.h"
#include "nodes/common/frame_pairer.h"

namespace object_modelling::nodes
{
namespace
{
sensor_msgs::Image::ConstPtr imageAt(double stamp_s)
{
  const sensor_msgs::Image::Ptr image(new sensor_msgs::Image);
  image->header.stamp = ros::Time(stamp_s);
  return image;
}

sensor_msgs::CameraInfo::ConstPtr info()
{
  return sensor_msgs::CameraInfo::ConstPtr(new sensor_msgs::CameraInfo);
}

TEST(FramePairer, GivesAFrameAsSoonAsItIsComplete)
{
  FramePairer pairer(0.02, false);
  EXPECT_FALSE(pairer.addInfo(info()));
  EXPECT_FALSE(pairer.addColor(imageAt(1)));
  const auto frame = pairer.addDepth(imageAt(1.01));
  ASSERT_TRUE(frame);
  EXPECT_EQ(ros::Time(1), frame->color->header.stamp);
  EXPECT_EQ(ros::Time(1.01), frame->depth->header.stamp);
  EXPECT_TRUE(frame->info);
  EXPECT_FALSE(frame->object_mask);
}

TEST(FramePairer, WaitsForTheFirstCameraInfo)
{
  FramePairer pairer(0.02, false);
  pairer.addColor(imageAt(1));
  EXPECT_FALSE(pairer.addDepth(imageAt(1)));
  EXPECT_TRUE(pairer.addInfo(info()));
  EXPECT_FALSE(pairer.addInfo(info()));
}

TEST(FramePairer, PairsTheNearestInStamp)
{
  FramePairer pairer(0.02, false);
  pairer.addInfo(info());
  pairer.addColor(imageAt(1.000));
  pairer.addColor(imageAt(1.033));
  const auto frame = pairer.addDepth(imageAt(1.018));
  ASSERT_TRUE(frame);
  EXPECT_EQ(ros::Time(1.033), frame->color->header.stamp);
  // What is older than a pair never pairs.
  EXPECT_FALSE(pairer.addDepth(imageAt(1.000)));
}

TEST(FramePairer, SaysHowFarStampsAreApart)
{
  FramePairer pairer(0.02, false);
  pairer.addInfo(info());
  EXPECT_LT(pairer.unpairedDifference_s(), 0);
  for (int i = 0; i < 100; ++i)
  {
    EXPECT_FALSE(pairer.addColor(imageAt(i)));
    EXPECT_FALSE(pairer.addDepth(imageAt(i + 0.4)));
  }
  EXPECT_NEAR(0.4, pairer.unpairedDifference_s(), 1e-6);
}

TEST(FramePairer, MasksBelongToTheirStampAlone)
{
  FramePairer pairer(0.02, true);
  pairer.addInfo(info());
  for (const double stamp_s : { 1.0, 2.0, 3.0 })
  {
    pairer.addColor(imageAt(stamp_s));
    EXPECT_FALSE(pairer.addDepth(imageAt(stamp_s)));
  }
  EXPECT_EQ(3u, pairer.waitingCount());
  EXPECT_FALSE(pairer.addMask(imageAt(1.5)));
  const auto frame = pairer.addMask(imageAt(2));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->color->header.stamp, frame->object_mask->header.stamp);
  EXPECT_EQ(1u, pairer.takeSkippedCount());  // the frame of 1.0 is too late now
  EXPECT_EQ(0u, pairer.takeSkippedCount());
  EXPECT_EQ(1u, pairer.waitingCount());
  // A mask may also come first.
  pairer.addMask(imageAt(4));
  pairer.addColor(imageAt(4));
  EXPECT_TRUE(pairer.addDepth(imageAt(4)));
}

TEST(FramePairer, StampsMayGoBack)
{
  FramePairer pairer(0.02, false);
  pairer.addInfo(info());
  pairer.addColor(imageAt(100));
  EXPECT_TRUE(pairer.addDepth(imageAt(100)));
  pairer.addColor(imageAt(1));
  EXPECT_TRUE(pairer.addDepth(imageAt(1)));
}

TEST(NewestSlot, DropsAndCountsWhatIsNotTaken)
{
  NewestSlot<int> slot;
  std::size_t dropped = 0;
  slot.put(1);
  slot.put(2);
  slot.addDropped(3);
  EXPECT_EQ(2, slot.take(&dropped).value());
  EXPECT_EQ(4u, dropped);
  slot.put(5);
  EXPECT_EQ(5, slot.take(&dropped).value());
  EXPECT_EQ(4u, dropped);
  slot.close();
  EXPECT_FALSE(slot.take(&dropped));
}
}  // namespace
}  // namespace object_modelling::nodes
