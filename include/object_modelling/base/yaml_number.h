#pragma once

#include <string>

namespace object_modelling::base
{
/// Shortest decimal that reads back as the same double, whatever the locale; .nan and .inf as YAML spells them.
std::string yamlNumber(double value);

}  // namespace object_modelling::base
