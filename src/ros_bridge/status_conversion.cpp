#include "object_modelling/ros_bridge/status_conversion.h"

namespace object_modelling::ros_bridge
{
object_modelling::Status toMessage(const base::Status& status)
{
  object_modelling::Status message;
  message.code = static_cast<std::uint8_t>(status.code);
  message.message = status.message;
  return message;
}

base::Status fromMessage(const object_modelling::Status& message)
{
  if (message.code > static_cast<std::uint8_t>(base::StatusCode::INTERNAL))
    return { base::StatusCode::INTERNAL,
             "status code " + std::to_string(message.code) + " is not known to this version: " + message.message };
  return { static_cast<base::StatusCode>(message.code), message.message };
}

void throwUnlessOk(const object_modelling::Status& message)
{
  const base::Status status = fromMessage(message);
  if (!status.ok())
    throw base::Error(status.code, status.message);
}

}  // namespace object_modelling::ros_bridge
