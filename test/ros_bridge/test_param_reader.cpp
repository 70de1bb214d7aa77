#include <gtest/gtest.h>

#include "object_modelling/base/status.h"
#include "object_modelling/ros_bridge/param_reader.h"
#include "support/thrown_status.h"

namespace object_modelling::ros_bridge
{
namespace
{
enum class Mode
{
  SLOW,
  FAST,
};

struct Options
{
  bool flag = false;
  int count = 3;
  std::uint64_t seed = 1;
  double ratio = 0.5;
  std::string name = "n";
  Mode mode = Mode::FAST;
};

Options read(XmlRpc::XmlRpcValue parameters)
{
  ParamReader reader("/node", parameters);
  Options options;
  reader.read("flag", options.flag);
  reader.read("group/count", options.count);
  reader.read("group/seed", options.seed);
  reader.read("ratio", options.ratio);
  reader.read("name", options.name);
  reader.read("mode", options.mode, { { "slow", Mode::SLOW }, { "fast", Mode::FAST } });
  if (options.count > 10)
    reader.include({ "group/count: too many" });
  reader.finish();
  return options;
}

std::string refusal(const XmlRpc::XmlRpcValue& parameters)
{
  try
  {
    read(parameters);
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(base::StatusCode::INVALID_ARGUMENT, error.code());
    return error.what();
  }
  return "nothing was refused";
}

TEST(ParamReader, DefaultsStayWithoutParameters)
{
  const Options options = read(XmlRpc::XmlRpcValue());
  EXPECT_EQ(3, options.count);
  EXPECT_EQ(Mode::FAST, options.mode);
}

TEST(ParamReader, ReadsEveryType)
{
  XmlRpc::XmlRpcValue parameters;
  parameters["flag"] = true;
  parameters["group"]["count"] = 5;
  parameters["group"]["seed"] = 42;
  parameters["ratio"] = 1;  // an integer is a number too
  parameters["name"] = std::string("other");
  parameters["mode"] = std::string("slow");
  const Options options = read(parameters);
  EXPECT_TRUE(options.flag);
  EXPECT_EQ(5, options.count);
  EXPECT_EQ(42u, options.seed);
  EXPECT_EQ(1.0, options.ratio);
  EXPECT_EQ("other", options.name);
  EXPECT_EQ(Mode::SLOW, options.mode);
}

TEST(ParamReader, SaysEverythingThatIsWrongAtOnce)
{
  XmlRpc::XmlRpcValue parameters;
  parameters["flag"] = 1;
  parameters["group"]["count"] = 11;
  parameters["group"]["seed"] = -1;
  parameters["ratio"] = std::string("half");
  parameters["mode"] = std::string("medium");
  parameters["group"]["cuont"] = 5;
  const std::string text = refusal(parameters);
  EXPECT_TRUE(test_support::mentions(text, "/node")) << text;
  EXPECT_TRUE(test_support::mentions(text, "flag = 1: must be true or false, is a integer")) << text;
  EXPECT_TRUE(test_support::mentions(text, "group/count: too many")) << text;
  EXPECT_TRUE(test_support::mentions(text, "group/seed = -1")) << text;
  EXPECT_TRUE(test_support::mentions(text, "ratio = half: must be a number")) << text;
  EXPECT_TRUE(test_support::mentions(text, "mode = \"medium\": must be one of slow, fast")) << text;
  EXPECT_TRUE(test_support::mentions(text, "group/cuont = 5: no such parameter")) << text;
  EXPECT_TRUE(test_support::mentions(text, "known are flag, group/count")) << text;
}

TEST(ParamReader, AScalarWhereAMapIsWanted)
{
  XmlRpc::XmlRpcValue parameters;
  parameters["group"] = 5;
  EXPECT_TRUE(test_support::mentions(refusal(parameters), "group = 5: no such parameter"));
}
}  // namespace
}  // namespace object_modelling::ros_bridge
