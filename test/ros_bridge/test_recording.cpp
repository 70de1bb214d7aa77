#include <fstream>

#include <gtest/gtest.h>

#include "bag_writer.h"
#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/recording.h"
#include "support/temp_dir.h"

namespace object_modelling::ros_bridge
{
namespace
{
std::string refusal(const std::string& path, base::StatusCode code)
{
  try
  {
    openRecording(path);
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(code, error.code()) << error.what();
    return error.what();
  }
  return "nothing was refused";
}

TEST(Recording, OpensFoldersAndBags)
{
  const auto folder = openRecording(OBJECT_MODELLING_TEST_DATA "/cereal_box_turntable");
  const auto raw = folder->next();
  ASSERT_TRUE(raw);
  EXPECT_FALSE(raw->object_mask.empty());

  const test_support::TempDir temp;
  const std::string path = temp.path("a.bag");
  test::BagWriter writer(path);
  writer.info("/rgb/camera_info", 1);
  writer.color("/rgb/image_color", 1, 1);
  writer.depth("/depth/image", 1, 1);
  writer.close();
  EXPECT_TRUE(openRecording(path)->next());
}

TEST(Recording, RefusesEverythingElse)
{
  const test_support::TempDir temp;
  const auto touch = [&](const std::string& name)
  {
    std::ofstream(temp.path(name)) << "x";
    return temp.path(name);
  };
  EXPECT_NE(std::string::npos, refusal(touch("a.oni"), base::StatusCode::BAD_INPUT).find(".oni is not supported yet"));
  EXPECT_NE(std::string::npos, refusal(touch("a.mp4"), base::StatusCode::BAD_INPUT).find("TUM-style folder"));
  EXPECT_NE(std::string::npos, refusal(temp.path("no"), base::StatusCode::NOT_FOUND).find("no such"));
}
}  // namespace
}  // namespace object_modelling::ros_bridge
