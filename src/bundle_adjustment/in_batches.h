#pragma once

#include <algorithm>
#include <string>

#include <opencv2/core/utility.hpp>

#include "object_modelling/base/job_control.h"

namespace object_modelling::bundle_adjustment
{
/// Calls work(i) for 0 <= i < count on all cores, in batches with progress. work(i) writes its own result only. Throws
/// what `control` throws when the job is cancelled.
template <typename Work>
void inBatches(const std::string& stage, int count, base::JobControl& control, const Work& work)
{
  // Work between two looks at the job control: short enough to stop soon, long enough to keep the cores busy.
  constexpr int BATCH = 16;
  for (int begin = 0; begin < count; begin += BATCH)
  {
    control.report(stage, static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
    cv::parallel_for_(cv::Range(begin, std::min(begin + BATCH, count)),
                      [&](const cv::Range& range)
                      {
                        for (int i = range.start; i < range.end; ++i)
                          work(i);
                      });
  }
}

}  // namespace object_modelling::bundle_adjustment
