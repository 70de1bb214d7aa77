#pragma once

#include <string>

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::cli
{
/// Where an object's sessions are, as the user named it; an empty database is left to the user.
struct ObjectPlace
{
  std::string object_id, store, database;
};

/// What a person can do so that the sessions left out take part. Without a store the sessions are gone with the run.
std::string remedyFor(const alignment::AlignmentResult& aligned, const ObjectPlace& place);

}  // namespace object_modelling::cli
