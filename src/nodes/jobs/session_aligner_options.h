#pragma once

#include <string>
#include <vector>

#include "../common/store_parameters.h"

namespace object_modelling::nodes
{
struct SessionAlignerOptions
{
  ros_bridge::RemoteSessionStoreOptions store;

  std::vector<std::string> violations() const { return {}; }
};

template <typename Reader>
void read(Reader& reader, SessionAlignerOptions* options)
{
  read(reader, &options->store);
}

}  // namespace object_modelling::nodes
