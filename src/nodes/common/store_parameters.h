#pragma once

#include "object_modelling/ros_bridge/remote_session_store.h"

namespace object_modelling::nodes
{
/// Keys store/... of every node that works on stored sessions.
template <typename Reader>
void read(Reader& reader, ros_bridge::RemoteSessionStoreOptions* options)
{
  reader.read("store/node", options->node);
  reader.read("store/connect_timeout_s", options->connect_timeout_s);
  reader.read("store/call_timeout_s", options->call_timeout_s);
  reader.include(options->violations());
}

}  // namespace object_modelling::nodes
