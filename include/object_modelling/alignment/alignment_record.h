#pragma once

#include "object_modelling/alignment/session_alignment.h"
#include "object_modelling/keyframes/alignment_record.h"

namespace object_modelling::alignment
{
/// An edge as the store keeps it, its best candidates with it, and back. Numbers come back as they were.
keyframes::AlignmentRecord recordOf(const AlignmentEdge& edge);
/// Throws base::Error (BAD_INPUT) that names the sessions and what is wrong.
AlignmentEdge edgeFrom(const keyframes::AlignmentRecord& record);

}  // namespace object_modelling::alignment
