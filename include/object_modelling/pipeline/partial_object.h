#pragma once

#include <string>
#include <vector>

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/database/object_model.h"
#include "object_modelling/keyframes/session_store.h"

// What becomes of an object whose sessions do not all fit each other.
namespace object_modelling::pipeline
{
/// How many of an object's sessions have to fit.
enum class Required
{
  TWO,  ///< NO_RESULT where no two fit
  ONE,  ///< where no two fit, the best one is placed alone: an object can be built in any case
  ALL   ///< NO_RESULT where one is left out
};

/// Makes of what was found what is required. The best session alone is one that a model has already, whose frame so
/// stays; or else the one that saw most of the surface; of equals the first. The message of an OK names it.
void require(Required required, keyframes::SessionStore& store, const std::vector<registration::PartialModel>& parts,
             alignment::AlignmentResult* aligned);

/// The sessions that were not placed, each with the reasons of its pairs.
std::vector<database::LeftOutSession> leftOutOf(const alignment::AlignmentResult& aligned);

/// The refused pair that would join one more session if a person accepted it: the most probable one that has a
/// candidate pose, null where none has.
const alignment::AlignmentEdge* joiningPair(const alignment::AlignmentResult& aligned);

}  // namespace object_modelling::pipeline
