#include "object_modelling/base/job_control.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace object_modelling::base
{
namespace
{
TEST(JobControl, ReportsReachTheCallback)
{
  std::vector<Progress> seen;
  JobControl control([&](const Progress& progress) { seen.push_back(progress); });
  control.report("fuse", 1, 3);
  control.report("mesh", 2, 2);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].stage, "fuse");
  EXPECT_EQ(seen[0].total, 3u);
  EXPECT_EQ(seen[1].done, 2u);
}

TEST(JobControl, WorksWithoutCallback)
{
  JobControl control;
  EXPECT_NO_THROW(control.report("fuse", 1, 3));
  EXPECT_NO_THROW(control.checkCancelled());
}

TEST(JobControl, CancelFromAnotherThreadStopsTheNextReport)
{
  int calls = 0;
  JobControl control([&](const Progress&) { ++calls; });
  std::thread([&] { control.cancel(); }).join();
  EXPECT_TRUE(control.cancelled());
  EXPECT_THROW(control.report("fuse", 1, 3), Cancelled);
  EXPECT_THROW(control.checkCancelled(), Cancelled);
  EXPECT_EQ(calls, 0);
}

TEST(JobControl, CancelledCarriesItsCode)
{
  EXPECT_EQ(Cancelled().code(), StatusCode::CANCELLED);
}

}  // namespace
}  // namespace object_modelling::base
