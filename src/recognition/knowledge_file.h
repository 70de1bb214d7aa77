#pragma once

#include <string>

#include "object_modelling/recognition/object_knowledge.h"

namespace object_modelling::recognition
{
/// What a file must have been learnt from to be of use: object, options, and versions of what learns.
std::string knowledgeKey(const std::string& content_hash, const LearningOptions& options);

/// Reads what the entry of the database does not have. False, and the object as it was, if there is no such file, one
/// of another key, or a damaged one.
bool readKnowledge(const std::string& path, const std::string& key, ObjectKnowledge* object);

/// Throws base::Error (STORAGE).
void writeKnowledge(const std::string& path, const std::string& key, const ObjectKnowledge& object);

}  // namespace object_modelling::recognition
