#pragma once

#include <string>
#include <vector>

#include "object_modelling/keyframes/session_store.h"

namespace object_modelling::nodes
{
/// INVALID_ARGUMENT for a name that is none; `what` is "object id" or "session id".
void checkId(const std::string& what, const std::string& value);

/// Ids of the sessions to build an object from: those asked for, or else those of the object, or else the last recorded
/// one if it names no object. NOT_FOUND, FAILED_PRECONDITION and INVALID_ARGUMENT name what is missing or wrong.
std::vector<std::string> chooseSessions(keyframes::SessionStore& store, const std::string& object_id,
                                        const std::vector<std::string>& asked_for, const std::string& last_session_id);

}  // namespace object_modelling::nodes
