#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "object_modelling/rgbd/frame_builder.h"

namespace object_modelling::source
{
/// A recording or device that delivers raw frames in time order. Not thread safe.
class FrameSource
{
public:
  virtual ~FrameSource() = default;
  /// Next frame, or nothing at the end. Throws base::Error (BAD_INPUT, naming the file) for an unreadable image; the
  /// call after that goes on behind it.
  virtual std::optional<rgbd::RawFrame> next() = 0;
  /// Number of frames; nothing for a live device.
  virtual std::optional<std::size_t> size() const = 0;
  /// Frame id of the colour camera's optical frame.
  virtual std::string frameId() const = 0;
  /// Human-readable name for messages: path or URI.
  virtual std::string name() const = 0;
};

}  // namespace object_modelling::source
