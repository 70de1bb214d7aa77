#pragma once

#include <string>

namespace object_modelling::keyframes
{
/// What is known of how two sessions of one object lie to each other, kept so that a session that is added later, and
/// what a person decided, do not cost the rest. One for a pair, in either order.
struct AlignmentRecord
{
  std::string session_a, session_b;
  std::string findings;  ///< YAML, as alignment::recordOf() writes it (docs/keyframe_store_schema.md)
};

}  // namespace object_modelling::keyframes
