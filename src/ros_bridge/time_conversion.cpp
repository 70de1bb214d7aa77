#include "object_modelling/ros_bridge/time_conversion.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace object_modelling::ros_bridge
{
ros::Time toTime(double stamp_s)
{
  if (!(stamp_s >= 0) || stamp_s >= static_cast<double>(std::numeric_limits<std::uint32_t>::max()))
    return {};
  const double seconds = std::floor(stamp_s);
  const auto nanoseconds = static_cast<std::uint64_t>(std::llround((stamp_s - seconds) * 1e9));
  return { static_cast<std::uint32_t>(seconds) + static_cast<std::uint32_t>(nanoseconds / 1000000000u),
           static_cast<std::uint32_t>(nanoseconds % 1000000000u) };
}

}  // namespace object_modelling::ros_bridge
