#pragma once

#include <object_modelling/Status.h>

#include "object_modelling/base/status.h"

namespace object_modelling::ros_bridge
{
object_modelling::Status toMessage(const base::Status& status);

/// A code that this version does not know becomes INTERNAL, with the number in the message.
base::Status fromMessage(const object_modelling::Status& message);

/// Throws what a response's status says.
void throwUnlessOk(const object_modelling::Status& message);

/// Runs `body` and turns whatever it throws into a Status: base::Error as it says, all else as INTERNAL.
template <typename Body>
base::Status guarded(Body&& body)
{
  try
  {
    body();
    return {};
  }
  catch (const base::Error& error)
  {
    return error.status();
  }
  catch (const std::exception& error)
  {
    return { base::StatusCode::INTERNAL, error.what() };
  }
}

/// Body of a service callback: the call succeeds at transport level, the caller sees the reason in response.status.
template <typename Response, typename Body>
bool answer(Response& response, Body&& body)
{
  response.status = toMessage(guarded(std::forward<Body>(body)));
  return true;
}

}  // namespace object_modelling::ros_bridge
