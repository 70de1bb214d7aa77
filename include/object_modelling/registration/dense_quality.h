#pragma once

#include <string>

#include "object_modelling/registration/dense_alignment.h"

namespace object_modelling::registration
{
/// How well surfaces fit, in one figure, to choose between poses.
double quality(const DenseTerm& term);

/// Surfaces that do not speak against a pose: they may take part in it.
bool plausible(const DenseTerm& term);

/// Surfaces that a predicted pose may rest on alone.
bool convincing(const DenseTerm& term);

/// Surfaces that a pose may rest on alone although nothing predicted it.
bool certain(const DenseTerm& term);

/// For messages.
std::string describe(const DenseTerm& term);

}  // namespace object_modelling::registration
