#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

// In a Debug build, so in that with sanitizers, what is read from something empty ends the test that does it.
namespace object_modelling
{
TEST(AssertionsDeathTest, AreOnInDebugBuilds)
{
#ifdef NDEBUG
  GTEST_SKIP() << "this is no Debug build";
#else
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  std::vector<int> nothing;
  EXPECT_DEATH(static_cast<void>(nothing.front()), "");
  EXPECT_DEATH(static_cast<void>(Eigen::VectorXd().maxCoeff()), "");
#endif
}
}  // namespace object_modelling
