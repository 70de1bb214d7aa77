#include "input_watch.h"

#include <sstream>

namespace object_modelling::nodes
{
InputWatch::InputWatch(double timeout_s, const ros::WallTime& started) : timeout_(timeout_s), last_frame_(started)
{
}

std::size_t InputWatch::add(const std::string& topic)
{
  topics_.push_back({ topic, last_frame_, false });
  return topics_.size() - 1;
}

void InputWatch::heard(std::size_t topic, const ros::WallTime& now)
{
  topics_[topic].last = now;
  topics_[topic].ever = true;
}

std::string InputWatch::silentTopics(const ros::WallTime& now) const
{
  std::string names;
  bool ever = true;
  for (const Topic& topic : topics_)
  {
    if (now - topic.last <= timeout_)
      continue;
    names += (names.empty() ? "" : ", ") + topic.name;
    ever = ever && topic.ever;
  }
  if (names.empty())
    return {};
  std::ostringstream text;
  text << "no message on " << names << (ever ? " any more" : " yet") << ", for more than " << timeout_.toSec()
       << " s; is the camera running and its topics remapped?";
  return text.str();
}

}  // namespace object_modelling::nodes
