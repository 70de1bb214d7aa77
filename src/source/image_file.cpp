#include "image_file.h"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>

#include "object_modelling/base/atomic_file.h"
#include "text_table.h"

namespace object_modelling::source
{
namespace
{
bool isJpeg(const std::string& bytes)
{
  return bytes.size() > 2 && bytes.compare(0, 2, "\xff\xd8") == 0;
}

/// Whether a JPEG is truncated: its end marker is missing. The decoder fills it up with gray and reports no error.
bool cutOffJpeg(const std::string& bytes)
{
  return isJpeg(bytes) &&
         bytes.find("\xff\xd9", bytes.size() - std::min<std::size_t>(bytes.size(), 64)) == std::string::npos;
}
}  // namespace

cv::Mat readImage(const std::string& path, int flags)
{
  const std::string bytes = base::readTextFile(path);
  cv::Mat image;
  if (!bytes.empty() && !cutOffJpeg(bytes))
  {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
    image = cv::imdecode(buffer, flags);
  }
  if (image.empty())
    throw badInput(path, "is not a readable image (" + std::to_string(bytes.size()) + " bytes): damaged or cut off?");
  return image;
}

}  // namespace object_modelling::source
