#include "recording_list.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "text_table.h"

namespace object_modelling::source
{
namespace
{
namespace fs = std::filesystem;

struct ListedImage
{
  double stamp_s;
  std::string path;
};

/// The folder may come from anywhere: its lists must not make us read elsewhere.
std::string pathInside(const std::string& folder, const std::string& listed, const std::string& where)
{
  const fs::path path = fs::path(listed).lexically_normal();
  if (path.is_absolute() || path.empty() || *path.begin() == ".." || *path.begin() == ".")
    throw badInput(where, "\"" + listed + "\" is not a path inside the recording's folder");
  return (fs::path(folder) / path).string();
}

std::vector<ListedImage> readList(const std::string& folder, const std::string& file)
{
  std::vector<ListedImage> images;
  for (const TextRow& row : readTextTable((fs::path(folder) / file).string()))
  {
    row.requireWords(2, "stamp path");
    images.push_back({ row.number(0), pathInside(folder, row.words[1], row.where) });
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const ListedImage& a, const ListedImage& b) { return a.stamp_s < b.stamp_s; });
  return images;
}

std::vector<RecordedFrame> readAssociations(const std::string& folder, const std::string& path)
{
  std::vector<RecordedFrame> frames;
  for (const TextRow& row : readTextTable(path))
  {
    row.requireWords(4, "stamp colour_path stamp depth_path");
    frames.push_back({ row.number(0),
                       row.number(2),
                       pathInside(folder, row.words[1], row.where),
                       pathInside(folder, row.words[3], row.where),
                       {} });
  }
  return frames;
}

/// The closest pair first, then the next of what is left (as the TUM benchmark's associate.py): each image is used
/// once.
std::vector<RecordedFrame> associate(const std::vector<ListedImage>& colors, const std::vector<ListedImage>& depths,
                                     double max_difference_s)
{
  struct Pair
  {
    double difference_s;
    std::size_t color, depth;
  };
  std::vector<Pair> pairs;
  std::size_t first = 0;
  for (std::size_t c = 0; c < colors.size(); ++c)
  {
    while (first < depths.size() && depths[first].stamp_s < colors[c].stamp_s - max_difference_s)
      ++first;
    for (std::size_t d = first; d < depths.size() && depths[d].stamp_s <= colors[c].stamp_s + max_difference_s; ++d)
      pairs.push_back({ std::abs(depths[d].stamp_s - colors[c].stamp_s), c, d });
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.difference_s < b.difference_s; });
  std::vector<bool> color_used(colors.size()), depth_used(depths.size());
  std::vector<RecordedFrame> frames;
  for (const Pair& pair : pairs)
  {
    if (color_used[pair.color] || depth_used[pair.depth])
      continue;
    color_used[pair.color] = depth_used[pair.depth] = true;
    frames.push_back({ colors[pair.color].stamp_s,
                       depths[pair.depth].stamp_s,
                       colors[pair.color].path,
                       depths[pair.depth].path,
                       {} });
  }
  return frames;
}

}  // namespace

std::vector<RecordedFrame> readRecordingList(const std::string& folder, double max_stamp_difference_s)
{
  const std::string associations = (fs::path(folder) / "associations.txt").string();
  std::vector<RecordedFrame> frames =
      fs::exists(associations)
          ? readAssociations(folder, associations)
          : associate(readList(folder, "rgb.txt"), readList(folder, "depth.txt"), max_stamp_difference_s);
  if (frames.empty())
    throw badInput(folder, "lists no pair of colour and depth image within " + std::to_string(max_stamp_difference_s) +
                               " s of each other");
  std::stable_sort(frames.begin(), frames.end(),
                   [](const RecordedFrame& a, const RecordedFrame& b) { return a.stamp_s < b.stamp_s; });
  const auto twice =
      std::adjacent_find(frames.begin(), frames.end(),
                         [](const RecordedFrame& a, const RecordedFrame& b) { return a.stamp_s == b.stamp_s; });
  if (twice != frames.end())
    throw badInput(folder, "lists the stamp " + std::to_string(twice->stamp_s) + " of " + twice->color_path +
                               " twice: stamps must differ");
  return frames;
}

void addMasks(const std::string& folder, std::vector<RecordedFrame>* frames)
{
  if (!fs::exists(fs::path(folder) / "mask.txt"))
    return;
  const auto microseconds = [](double stamp_s) { return std::llround(stamp_s * 1e6); };
  std::map<long long, std::string> masks;
  for (const ListedImage& image : readList(folder, "mask.txt"))
    masks[microseconds(image.stamp_s)] = image.path;
  for (RecordedFrame& frame : *frames)
  {
    const auto mask = masks.find(microseconds(frame.stamp_s));
    if (mask != masks.end())
      frame.mask_path = mask->second;
  }
}

}  // namespace object_modelling::source
