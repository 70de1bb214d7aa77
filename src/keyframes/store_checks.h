#pragma once

#include <string>

#include "object_modelling/keyframes/session_store.h"

/// What a store refuses before it begins a transaction. All throw base::Error (INVALID_ARGUMENT) naming the session.
namespace object_modelling::keyframes
{
/// The session in messages.
std::string sessionText(const std::string& id);

void checkSessionId(const std::string& id);
void checkSession(const Session& session);
void checkChange(const std::string& session_id, const SessionChange& change);
void checkAlignment(const AlignmentRecord& record);

}  // namespace object_modelling::keyframes
