#pragma once

#include <string>
#include <vector>

#include "object_modelling/base/status.h"

namespace object_modelling::nodes
{
inline std::string joined(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}

inline void requireSessions(const std::vector<std::string>& session_ids)
{
  if (session_ids.empty())
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, "no session ids given: name at least one stored session");
}

}  // namespace object_modelling::nodes
