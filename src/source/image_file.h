#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace object_modelling::source
{
/// An image file decoded by cv::imdecode with `flags`. Throws base::Error (BAD_INPUT naming the file; NOT_FOUND).
cv::Mat readImage(const std::string& path, int flags);

}  // namespace object_modelling::source
