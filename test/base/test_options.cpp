#include "object_modelling/base/options.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/violations.h"

namespace object_modelling::base
{
namespace
{
struct Inner
{
  int count = 3;
  std::vector<std::string> violations() const
  {
    OptionsCheck check("inner");
    check.atLeast("count", count, 1);
    return check.violations();
  }
};

struct Outer
{
  double ratio = 0.5;
  double width_m = 1;
  Inner inner;
  std::vector<std::string> violations() const
  {
    OptionsCheck check("outer");
    check.inRange("ratio", ratio, 0.0, 1.0);
    check.positive("width_m", width_m);
    check.include(inner.violations());
    check.require("width_m", width_m < 10, "must be less than 10");
    return check.violations();
  }
};

TEST(Options, GoodOnesPassThrough)
{
  const Outer options;
  EXPECT_TRUE(options.violations().empty());
  EXPECT_EQ(&checked(options), &options);
}

TEST(Options, EveryBrokenBoundIsNamedAtOnce)
{
  Outer options;
  options.ratio = 2;
  options.width_m = -1;
  options.inner.count = 0;
  try
  {
    checked(options);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_STREQ(error.what(),
                 "invalid options:\n"
                 "  outer/ratio = 2: must be within [0, 1]\n"
                 "  outer/width_m = -1: must be greater than 0\n"
                 "  inner/count = 0: must be at least 1");
  }
}

TEST(Options, NotANumberBreaksEveryBound)
{
  Outer options;
  options.ratio = std::numeric_limits<double>::quiet_NaN();
  options.width_m = options.ratio;
  EXPECT_EQ(test_support::namesOf(options.violations()), (std::vector<std::string>{ "ratio", "width_m", "width_m" }));
}

TEST(Options, BoundsAreInclusive)
{
  Outer options;
  options.ratio = 0;
  EXPECT_TRUE(options.violations().empty());
  options.ratio = 1;
  EXPECT_TRUE(options.violations().empty());
}

TEST(Status, ErrorBecomesStatus)
{
  const Status status = Error(StatusCode::STORAGE, "disk full").status();
  EXPECT_EQ(status.code, StatusCode::STORAGE);
  EXPECT_EQ(status.message, "disk full");
  EXPECT_FALSE(status.ok());
  EXPECT_TRUE(Status().ok());
}

}  // namespace
}  // namespace object_modelling::base
