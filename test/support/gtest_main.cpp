#include <glog/logging.h>
#include <gtest/gtest.h>

/// catkin links gtest without its main; this one is taken where a test has none of its own.
int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  google::InitGoogleLogging(argv[0]);
  FLAGS_logtostderr = true;
  return RUN_ALL_TESTS();
}
