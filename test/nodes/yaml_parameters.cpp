#include "yaml_parameters.h"

#include <yaml-cpp/yaml.h>

namespace object_modelling::test
{
namespace
{
XmlRpc::XmlRpcValue scalar(const YAML::Node& node)
{
  if (node.Tag() == "!")  // quoted
    return XmlRpc::XmlRpcValue(node.as<std::string>());
  int integer = 0;
  double number = 0;
  bool truth = false;
  if (YAML::convert<int>::decode(node, integer))
    return XmlRpc::XmlRpcValue(integer);
  if (YAML::convert<double>::decode(node, number))
    return XmlRpc::XmlRpcValue(number);
  if (YAML::convert<bool>::decode(node, truth))
    return XmlRpc::XmlRpcValue(truth);
  return XmlRpc::XmlRpcValue(node.as<std::string>());
}

XmlRpc::XmlRpcValue convert(const YAML::Node& node)
{
  if (node.IsScalar())
    return scalar(node);
  XmlRpc::XmlRpcValue map;
  for (const auto& entry : node)
    map[entry.first.as<std::string>()] = convert(entry.second);
  return map;
}

void collect(const std::string& prefix, XmlRpc::XmlRpcValue value, std::map<std::string, XmlRpc::XmlRpcValue>* leaves)
{
  if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct)
  {
    (*leaves)[prefix] = value;
    return;
  }
  for (auto& [key, entry] : value)
    collect(prefix.empty() ? key : prefix + "/" + key, entry, leaves);
}
}  // namespace

XmlRpc::XmlRpcValue loadYaml(const std::string& path)
{
  return convert(YAML::LoadFile(path));
}

std::map<std::string, XmlRpc::XmlRpcValue> leaves(const XmlRpc::XmlRpcValue& map)
{
  std::map<std::string, XmlRpc::XmlRpcValue> found;
  collect("", map, &found);
  return found;
}

}  // namespace object_modelling::test
