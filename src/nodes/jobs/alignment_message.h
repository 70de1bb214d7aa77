#pragma once

#include <object_modelling/AlignmentEdge.h>

#include "object_modelling/alignment/session_alignment.h"

namespace object_modelling::nodes
{
/// Candidates that a person sees and can pick from.
constexpr std::size_t SHOWN_CANDIDATES = 3;

object_modelling::AlignmentEdge toMessage(const alignment::AlignmentEdge& edge);

}  // namespace object_modelling::nodes
