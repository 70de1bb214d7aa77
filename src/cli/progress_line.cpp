#include "progress_line.h"

#include <unistd.h>

#include <cstdio>

namespace object_modelling::cli
{
namespace
{
constexpr int BAR_WIDTH = 32;
constexpr std::chrono::milliseconds REDRAW_INTERVAL{ 100 };
}  // namespace

ProgressLine::ProgressLine(bool enabled) : enabled_(enabled), terminal_(isatty(STDERR_FILENO) == 1)
{
}

ProgressLine::~ProgressLine()
{
  finishLine();
}

void ProgressLine::finishLine()
{
  if (drawn_)
    std::fputc('\n', stderr);
  drawn_ = false;
}

void ProgressLine::show(const base::Progress& progress)
{
  if (!enabled_)
    return;
  const bool new_stage = progress.stage != stage_;
  if (new_stage)
  {
    finishLine();
    stage_ = progress.stage;
    if (!terminal_)
      std::fprintf(stderr, "%s ...\n", stage_.c_str());
  }
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || (!new_stage && progress.done < progress.total && now - last_ < REDRAW_INTERVAL))
    return;
  last_ = now;
  drawn_ = true;
  if (progress.total == 0)
  {
    std::fprintf(stderr, "\r%-10s %zu", stage_.c_str(), progress.done);
    return;
  }
  const int filled = static_cast<int>(progress.done * BAR_WIDTH / progress.total);
  std::fprintf(stderr, "\r%-10s [%s%s] %zu/%zu", stage_.c_str(), std::string(filled, '=').c_str(),
               std::string(BAR_WIDTH - filled, ' ').c_str(), progress.done, progress.total);
}

}  // namespace object_modelling::cli
