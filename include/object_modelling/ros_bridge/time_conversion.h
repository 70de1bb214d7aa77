#pragma once

#include <ros/time.h>

namespace object_modelling::ros_bridge
{
/// Seconds as double hold a present-day stamp to a quarter of a microsecond. Negative or absurd values become 0.
ros::Time toTime(double stamp_s);
inline double toSeconds(const ros::Time& stamp)
{
  return stamp.toSec();
}

}  // namespace object_modelling::ros_bridge
