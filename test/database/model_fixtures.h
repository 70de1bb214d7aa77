#pragma once

#include <map>
#include <string>

#include "object_modelling/database/object_model.h"
#include "support/thrown_status.h"

namespace object_modelling::database
{
/// A box of 80 x 120 x 200 mm with everything a model can hold; `variant` changes its content. The object frame is the
/// synthetic scene's world.
ObjectModel makeModel(const std::string& id, int variant = 0, int view_count = 2);

/// Content of every file below a folder by relative path.
std::map<std::string, std::string> contentsOf(const std::string& folder);

using test_support::mentions;
using test_support::statusOf;

}  // namespace object_modelling::database
