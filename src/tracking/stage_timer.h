#pragma once

#include <chrono>

namespace object_modelling::tracking
{
/// Adds the wall time until stop(), or its end, to a sum.
class StageTimer
{
public:
  explicit StageTimer(double* sum_ms) : sum_ms_(sum_ms) {}
  ~StageTimer() { stop(); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

  void stop()
  {
    if (sum_ms_)
      *sum_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    sum_ms_ = nullptr;
  }

private:
  double* sum_ms_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace object_modelling::tracking
