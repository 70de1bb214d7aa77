#include <gtest/gtest.h>

#include "nodes/common/run_node.h"
#include "nodes/jobs/model_builder_options.h"
#include "nodes/jobs/refiner_options.h"
#include "nodes/jobs/session_aligner_options.h"
#include "nodes/manager/manager_options.h"
#include "nodes/recogniser/recogniser_options.h"
#include "nodes/segmenter/segmenter_options.h"
#include "support/violations.h"
#include "yaml_parameters.h"

// Each shipped config/<node>.yaml is read by the node's own loader, holds every key, and says what the options'
// defaults say: the nodes and the command line, which reads no YAML, give the same results.
namespace object_modelling::nodes
{
namespace
{
std::string configPath(const std::string& node)
{
  return std::string(OBJECT_MODELLING_CONFIG) + "/" + node + ".yaml";
}

double number(XmlRpc::XmlRpcValue value)
{
  return value.getType() == XmlRpc::XmlRpcValue::TypeInt ? static_cast<int>(value) : static_cast<double>(value);
}

bool isNumber(const XmlRpc::XmlRpcValue& value)
{
  return value.getType() == XmlRpc::XmlRpcValue::TypeInt || value.getType() == XmlRpc::XmlRpcValue::TypeDouble;
}

template <typename Options>
void expectDefaults(const std::string& node)
{
  const XmlRpc::XmlRpcValue yaml = test::loadYaml(configPath(node));
  ros_bridge::ParamReader reader(node, yaml);
  optionsFrom<Options>(reader);
  EXPECT_NO_THROW(reader.finish());

  Options defaults;
  test::FieldList known;
  read(known, &defaults);
  const std::map<std::string, XmlRpc::XmlRpcValue> shipped = test::leaves(yaml);
  for (const auto& [key, value] : known.fields)
  {
    const auto found = shipped.find(key);
    if (found == shipped.end())
    {
      ADD_FAILURE() << configPath(node) << " lacks " << key;
      continue;
    }
    if (isNumber(value) && isNumber(found->second))
      EXPECT_DOUBLE_EQ(number(found->second), number(value)) << node << "/" << key;
    else
      EXPECT_TRUE(XmlRpc::XmlRpcValue(found->second) == value) << node << "/" << key;
  }
  EXPECT_EQ(shipped.size(), known.fields.size());
}
}  // namespace

TEST(Config, Segmenter)
{
  expectDefaults<SegmenterOptions>("segmenter");
}
TEST(Config, Refiner)
{
  expectDefaults<RefinerOptions>("refiner");
}
TEST(Config, SessionAligner)
{
  expectDefaults<SessionAlignerOptions>("session_aligner");
}
TEST(Config, ModelBuilder)
{
  expectDefaults<ModelBuilderOptions>("model_builder");
}
TEST(Config, ModellingManager)
{
  expectDefaults<ManagerOptions>("modelling_manager");
}

TEST(Config, Recogniser)
{
  expectDefaults<RecogniserNodeOptions>("recogniser");
}

TEST(Config, BoundsOfTheModellingManager)
{
  ManagerOptions options;
  options.service_wait_s = -1;
  options.job_silence_s = 3601;
  EXPECT_EQ(test_support::namesOf(options.violations()),
            (std::vector<std::string>{ "job_silence_s", "service_wait_s" }));
  EXPECT_NE(options.violations()[0].find("modelling_manager/service_wait_s = -1"), std::string::npos);
}

TEST(Config, MistakesAreListedTogether)
{
  XmlRpc::XmlRpcValue parameters;
  parameters["preview_rate_hz"] = -1.0;
  parameters["automatic"] = std::string("perhaps");
  parameters["scene"]["min_cluster"] = 3;
  ros_bridge::ParamReader reader("segmenter", parameters);
  optionsFrom<SegmenterOptions>(reader);
  try
  {
    reader.finish();
    FAIL() << "accepted";
  }
  catch (const base::Error& error)
  {
    for (const char* part : { "preview_rate_hz", "automatic", "scene/min_cluster" })
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " is missing in " << error.what();
  }
}

}  // namespace object_modelling::nodes
