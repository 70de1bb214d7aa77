#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>

#include "object_modelling/base/status.h"

namespace object_modelling::base
{
/// Progress of a long job: `done` of `total` units of the named stage.
struct Progress
{
  std::string stage;
  std::size_t done = 0;
  std::size_t total = 0;
};

/// Thrown by JobControl::report() and checkCancelled() after cancel(); a job unwinds without leaving anything half
/// done.
class Cancelled : public Error
{
public:
  Cancelled() : Error(StatusCode::CANCELLED, "cancelled on request; nothing was changed") {}
};

/// The hand that the caller of a long job keeps on it. cancel() may be called from any thread; report() is called by
/// the thread that runs the job, and calls the callback on it.
class JobControl
{
public:
  using Callback = std::function<void(const Progress&)>;

  JobControl() = default;
  explicit JobControl(Callback callback) : callback_(std::move(callback)) {}
  JobControl(const JobControl&) = delete;
  JobControl& operator=(const JobControl&) = delete;

  void cancel() { cancelled_ = true; }
  bool cancelled() const { return cancelled_; }
  void checkCancelled() const
  {
    if (cancelled_)
      throw Cancelled();
  }
  void report(const std::string& stage, std::size_t done, std::size_t total)
  {
    checkCancelled();
    if (callback_)
      callback_({ stage, done, total });
  }

private:
  Callback callback_;
  std::atomic<bool> cancelled_{ false };
};

}  // namespace object_modelling::base
