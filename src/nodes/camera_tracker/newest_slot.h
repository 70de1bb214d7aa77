#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

namespace object_modelling::nodes
{
/// Hands the newest value from one thread to another; what was not taken in time is dropped and counted.
template <typename T>
class NewestSlot
{
public:
  void put(T value)
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      dropped_count_ += value_.has_value() ? 1 : 0;
      value_ = std::move(value);
    }
    changed_.notify_one();
  }

  /// Waits for a value; nothing after close(). Adds to `dropped_count` what was dropped since the last call.
  std::optional<T> take(std::size_t* dropped_count)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || value_.has_value(); });
    *dropped_count += dropped_count_;
    dropped_count_ = 0;
    if (closed_)
      return {};
    std::optional<T> taken = std::move(value_);
    value_.reset();
    return taken;
  }

  /// Counts values that were lost before they got here.
  void addDropped(std::size_t count)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    dropped_count_ += count;
  }

  void close()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<T> value_;
  std::size_t dropped_count_ = 0;
  bool closed_ = false;
};

}  // namespace object_modelling::nodes
