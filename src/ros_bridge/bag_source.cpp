#include "object_modelling/ros_bridge/bag_source.h"

#include <filesystem>

#include <rosbag/bag.h>
#include <rosbag/exceptions.h>

#include "bag_messages.h"
#include "bag_topics.h"
#include "object_modelling/base/options.h"
#include "object_modelling/ros_bridge/frame_conversion.h"
#include "object_modelling/ros_bridge/image_conversion.h"

namespace object_modelling::ros_bridge
{
namespace
{
/// Runs `body`; errors of the file are thrown with its path and a remedy.
template <typename Body>
auto readingBag(const std::string& path, Body&& body)
{
  try
  {
    return body();
  }
  catch (const rosbag::BagUnindexedException&)
  {
    throw base::Error(base::StatusCode::BAD_INPUT,
                      path + ": the bag has no index, its recording was interrupted; run: rosbag reindex " + path);
  }
  catch (const rosbag::BagException& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT, path + ": the bag is damaged or truncated (" + error.what() +
                                                       "); rosbag fix or a new copy may help");
  }
  catch (const ros::serialization::StreamOverrunException& error)
  {
    throw base::Error(base::StatusCode::BAD_INPUT, path + ": a message of the bag is cut short (" + error.what() + ")");
  }
}

class BagSource : public source::FrameSource
{
public:
  BagSource(const std::string& path, const BagSourceOptions& options) : path_(path)
  {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
      throw base::Error(base::StatusCode::NOT_FOUND, path + ": there is no such bag");
    readingBag(path_,
               [&]
               {
                 bag_.open(path_, rosbag::bagmode::Read);
                 topics_ = findTopics(bag_, path_, options.topics);
                 messages_ = std::make_unique<BagMessages>(bag_, topics_, options.max_stamp_difference_s);
                 more_ = messages_->next(&instant_);
               });
    if (!more_)
      throw base::Error(base::StatusCode::BAD_INPUT,
                        path_ + ": no image of " + topics_.color + " has a partner in " + topics_.depth +
                            " within max_stamp_difference_s = " + std::to_string(options.max_stamp_difference_s));
    if (!instant_.info)
      throw base::Error(base::StatusCode::BAD_INPUT, path_ + ": topic " + topics_.camera_info + " has no message");
    const base::Status registered = checkRegistered(instant_.color->header, instant_.depth->header);
    if (!registered.ok())
      throw base::Error(registered.code, path_ + ": " + registered.message);
    frame_id_ = instant_.color->header.frame_id;
  }

  std::optional<rgbd::RawFrame> next() override
  {
    if (!more_)
      return {};
    const bool rectified = topics_.color.find("rect") != std::string::npos;
    return readingBag(path_,
                      [&]() -> std::optional<rgbd::RawFrame>
                      {
                        const BagInstant current = instant_;
                        more_ = false;  // should the bag be damaged from here on
                        more_ = messages_->next(&instant_);
                        return rawFrame(current, rectified ? ImageKind::RECTIFIED : ImageKind::RAW);
                      });
  }

  std::optional<std::size_t> size() const override { return messages_->colorCount(); }
  std::string frameId() const override { return frame_id_; }
  std::string name() const override { return path_; }

private:
  rgbd::RawFrame rawFrame(const BagInstant& instant, ImageKind kind) const
  {
    try
    {
      rgbd::RawFrame raw = rawFrameFromMessages(*instant.color, *instant.depth, *instant.info, kind);
      if (instant.object_mask)
        raw.object_mask = maskFromMessage(*instant.object_mask);
      return raw;
    }
    catch (const base::Error& error)
    {
      throw base::Error(error.code(), path_ + ": " + error.what());
    }
  }

  std::string path_, frame_id_;
  rosbag::Bag bag_;
  BagTopics topics_;
  std::unique_ptr<BagMessages> messages_;
  BagInstant instant_;
  bool more_ = false;
};
}  // namespace

std::vector<std::string> BagSourceOptions::violations() const
{
  base::OptionsCheck check("bag");
  check.positive("max_stamp_difference_s", max_stamp_difference_s);
  return check.violations();
}

std::unique_ptr<source::FrameSource> openBag(const std::string& path, const BagSourceOptions& options)
{
  return std::make_unique<BagSource>(path, base::checked(options));
}

}  // namespace object_modelling::ros_bridge
