#include "bag_topics.h"

#include <algorithm>
#include <map>
#include <vector>

#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "object_modelling/ros_bridge/image_conversion.h"
#include "object_modelling/ros_bridge/names.h"

namespace object_modelling::ros_bridge
{
namespace
{
struct Contents
{
  std::map<std::string, std::string> image_encodings;  ///< encoding of the first message, by topic
  std::vector<std::string> infos;
};

bool endsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Contents contentsOf(rosbag::Bag& bag)
{
  Contents contents;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections())
  {
    if (connection->datatype == "sensor_msgs/CameraInfo")
      contents.infos.push_back(connection->topic);
    if (connection->datatype != "sensor_msgs/Image" || contents.image_encodings.count(connection->topic) > 0)
      continue;
    rosbag::View view(bag, rosbag::TopicQuery(connection->topic));
    for (const rosbag::MessageInstance& instance : view)
    {
      if (const auto image = instance.instantiate<sensor_msgs::Image>())
        contents.image_encodings[connection->topic] = image->encoding;
      break;
    }
  }
  std::sort(contents.infos.begin(), contents.infos.end());
  contents.infos.erase(std::unique(contents.infos.begin(), contents.infos.end()), contents.infos.end());
  return contents;
}

std::string listed(const Contents& contents)
{
  std::string text;
  for (const auto& [topic, encoding] : contents.image_encodings)
    text += "\n  " + topic + " (image, " + encoding + ")";
  for (const std::string& topic : contents.infos)
    text += "\n  " + topic + " (camera_info)";
  return text.empty() ? "\n  no sensor_msgs/Image and no sensor_msgs/CameraInfo topic" : text;
}

class TopicFinder
{
public:
  TopicFinder(const std::string& path, const Contents& contents) : path_(path), contents_(contents) {}

  std::string image(const std::string& wanted, bool depth, const std::string& usual_name) const
  {
    if (!wanted.empty())
      return named(wanted, contents_.image_encodings.count(wanted) > 0);
    std::vector<std::string> fitting;
    for (const auto& [topic, encoding] : contents_.image_encodings)
      if (isDepthEncoding(encoding) == depth && !endsWith(topic, names::OBJECT_MASK))
        fitting.push_back(topic);
    return only(fitting, depth ? "depth" : "colour", usual_name);
  }

  std::string info(const std::string& wanted, const std::string& color) const
  {
    const auto has = [this](const std::string& topic)
    { return std::find(contents_.infos.begin(), contents_.infos.end(), topic) != contents_.infos.end(); };
    if (!wanted.empty())
      return named(wanted, has(wanted));
    const std::string beside = color.substr(0, color.rfind('/') + 1) + "camera_info";
    return has(beside) ? beside : only(contents_.infos, "camera_info", names::CAMERA_INFO);
  }

  std::string mask(const std::string& wanted) const
  {
    if (!wanted.empty())
      return named(wanted, contents_.image_encodings.count(wanted) > 0);
    for (const auto& entry : contents_.image_encodings)
      if (endsWith(entry.first, names::OBJECT_MASK))
        return entry.first;
    return {};
  }

private:
  std::string named(const std::string& topic, bool there) const
  {
    if (!there)
      throw base::Error(base::StatusCode::NOT_FOUND,
                        path_ + ": has no usable topic " + topic + "; it holds" + listed(contents_));
    return topic;
  }

  std::string only(const std::vector<std::string>& fitting, const std::string& what,
                   const std::string& usual_name) const
  {
    if (fitting.size() == 1)
      return fitting.front();
    std::vector<std::string> usual;
    std::copy_if(fitting.begin(), fitting.end(), std::back_inserter(usual),
                 [&](const std::string& topic) { return endsWith(topic, usual_name); });
    if (usual.size() == 1)
      return usual.front();
    throw base::Error(base::StatusCode::BAD_INPUT,
                      path_ +
                          (fitting.empty() ? ": has no " + what + " topic; it holds"
                                           : ": has several " + what + " topics, name the one to use; it holds") +
                          listed(contents_));
  }

  const std::string& path_;
  const Contents& contents_;
};
}  // namespace

BagTopics findTopics(rosbag::Bag& bag, const std::string& path, const BagTopics& wanted)
{
  const Contents contents = contentsOf(bag);
  const TopicFinder finder(path, contents);
  BagTopics found;
  found.color = finder.image(wanted.color, false, names::COLOR);
  found.depth = finder.image(wanted.depth, true, names::DEPTH);
  found.camera_info = finder.info(wanted.camera_info, found.color);
  found.object_mask = finder.mask(wanted.object_mask);
  return found;
}

}  // namespace object_modelling::ros_bridge
