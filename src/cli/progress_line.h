#pragma once

#include <chrono>
#include <string>

#include "object_modelling/base/job_control.h"

namespace object_modelling::cli
{
/// One line on stderr that shows stage, bar and count. On a terminal it is redrawn in place, at most ten times a
/// second; elsewhere one line is written when a stage begins, so that logs stay readable.
class ProgressLine
{
public:
  explicit ProgressLine(bool enabled);
  ~ProgressLine();
  void show(const base::Progress& progress);

private:
  void finishLine();

  bool enabled_;
  bool terminal_;
  bool drawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace object_modelling::cli
