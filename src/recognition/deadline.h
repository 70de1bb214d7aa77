#pragma once

#include <chrono>
#include <optional>

namespace object_modelling::recognition
{
/// Point in time by the steady clock after which no new work begins.
class Deadline
{
public:
  /// From now; 0: never.
  explicit Deadline(double seconds)
  {
    if (seconds > 0)
      end_ = std::chrono::steady_clock::now() +
             std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
  }

  bool passed() const { return end_ && std::chrono::steady_clock::now() > *end_; }

private:
  std::optional<std::chrono::steady_clock::time_point> end_;
};

}  // namespace object_modelling::recognition
