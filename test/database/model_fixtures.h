#pragma once

#include <functional>
#include <map>
#include <string>

#include "object_modelling/base/status.h"
#include "object_modelling/database/object_model.h"

namespace object_modelling::database
{
/// A box of 80 x 120 x 200 mm with everything a model can hold; `variant` changes its content. The object frame is the
/// synthetic scene's world.
ObjectModel makeModel(const std::string& id, int variant = 0, int view_count = 2);

/// Content of every file below a folder by relative path.
std::map<std::string, std::string> contentsOf(const std::string& folder);

/// Status of the base::Error that the call throws; OK if none.
base::Status statusOf(const std::function<void()>& call);

bool mentions(const base::Status& status, const std::string& text);

}  // namespace object_modelling::database
