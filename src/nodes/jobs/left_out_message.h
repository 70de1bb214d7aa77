#pragma once

#include <object_modelling/SessionLeftOut.h>

#include "object_modelling/database/object_model.h"

namespace object_modelling::nodes
{
inline object_modelling::SessionLeftOut leftOutMessage(const database::LeftOutSession& session)
{
  object_modelling::SessionLeftOut message;
  message.session_id = session.id;
  message.reason = session.reason;
  return message;
}

inline database::LeftOutSession leftOutFrom(const object_modelling::SessionLeftOut& message)
{
  return { message.session_id, message.reason };
}

}  // namespace object_modelling::nodes
