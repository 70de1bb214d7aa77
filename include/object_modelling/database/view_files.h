#pragma once

#include <string>
#include <vector>

#include "object_modelling/rgbd/view.h"

namespace object_modelling::database
{
/// The stored views of an object, at most `max_views` of them, spread evenly over their order (0: all). World: the
/// object frame; the session's index is its place among those of the object. Colour is as JPEG left it; depth is that
/// of the stored clouds; the noise model is the default. Throws base::Error (NOT_FOUND, BAD_INPUT naming the file).
std::vector<rgbd::View> readViews(const std::string& object_folder, std::size_t max_views = 0);

}  // namespace object_modelling::database
