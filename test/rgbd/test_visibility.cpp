#include "object_modelling/rgbd/visibility.h"

#include <limits>

#include <gtest/gtest.h>

namespace object_modelling::rgbd
{
TEST(Visibility, ComparesAPointWithWhatWasMeasured)
{
  EXPECT_EQ(visibilityOf(1.0, 1.2, 0.1), Visibility::IN_FRONT);
  EXPECT_EQ(visibilityOf(1.0, 0.8, 0.1), Visibility::BEHIND);
  EXPECT_EQ(visibilityOf(1.0, 1.05, 0.1), Visibility::ON);
  EXPECT_EQ(visibilityOf(1.0, 0.95, 0.1), Visibility::ON);
}

TEST(Visibility, TheToleranceItselfIsOn)
{
  EXPECT_EQ(visibilityOf(1.0F, 1.25F, 0.25F), Visibility::ON);
  EXPECT_EQ(visibilityOf(1.0F, 0.75F, 0.25F), Visibility::ON);
}

TEST(Visibility, IsUnknownWhereNothingWasMeasured)
{
  EXPECT_EQ(visibilityOf(1.0F, std::numeric_limits<float>::quiet_NaN(), 0.1F), Visibility::UNKNOWN);
  EXPECT_EQ(visibilityOf(1.0F, std::numeric_limits<float>::infinity(), 0.1F), Visibility::UNKNOWN);
  EXPECT_EQ(visibilityOf(1.0F, 0.0F, 0.1F), Visibility::UNKNOWN);
}

}  // namespace object_modelling::rgbd
