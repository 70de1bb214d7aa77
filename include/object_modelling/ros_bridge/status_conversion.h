#pragma once

#include <object_modelling/Status.h>

#include "object_modelling/base/status.h"

namespace object_modelling::ros_bridge
{
object_modelling::Status toMessage(const base::Status& status);

/// A code unknown to this version becomes INTERNAL, with the number in the message.
base::Status fromMessage(const object_modelling::Status& message);

/// Throws base::Error with a response's code and message unless the code is OK.
void throwUnlessOk(const object_modelling::Status& message);

/// Runs `body` and converts whatever it throws to a Status: base::Error with its code, all else to INTERNAL.
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
