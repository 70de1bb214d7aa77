#pragma once

#include <string>

#include "object_modelling/base/status.h"

namespace object_modelling::test_support
{
/// Status of the base::Error that the call throws; OK if none.
template <typename Call>
base::Status statusOf(const Call& call)
{
  try
  {
    call();
  }
  catch (const base::Error& error)
  {
    return error.status();
  }
  return {};
}

inline bool mentions(const std::string& message, const std::string& text)
{
  return message.find(text) != std::string::npos;
}

inline bool mentions(const base::Status& status, const std::string& text)
{
  return mentions(status.message, text);
}

}  // namespace object_modelling::test_support
