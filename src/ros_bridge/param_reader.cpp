#include "object_modelling/ros_bridge/param_reader.h"

#include <algorithm>
#include <sstream>

#include <ros/console.h>

#include "object_modelling/base/status.h"

namespace object_modelling::ros_bridge
{
namespace
{
using XmlRpc::XmlRpcValue;

std::string typeName(const XmlRpcValue& value)
{
  switch (value.getType())
  {
    case XmlRpcValue::TypeBoolean:
      return "boolean";
    case XmlRpcValue::TypeInt:
      return "integer";
    case XmlRpcValue::TypeDouble:
      return "number";
    case XmlRpcValue::TypeString:
      return "string";
    case XmlRpcValue::TypeArray:
      return "list";
    case XmlRpcValue::TypeStruct:
      return "map";
    default:
      return "value of another kind";
  }
}

std::string textOf(const XmlRpcValue& value)
{
  std::ostringstream text;
  value.write(text);
  return text.str();
}

XmlRpcValue privateParameters(const ros::NodeHandle& node)
{
  XmlRpcValue parameters;
  node.getParam(node.getNamespace(), parameters);
  return parameters;
}

/// XmlRpcValue's conversions are not const on every release.
template <typename T>
T as(XmlRpcValue value)  // NOLINT(performance-unnecessary-value-param)
{
  return static_cast<T>(value);
}

std::string joined(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}
}  // namespace

ParamReader::ParamReader(const ros::NodeHandle& private_node)
    : ParamReader(private_node.getNamespace(), privateParameters(private_node))
{
}

ParamReader::ParamReader(const std::string& name, const XmlRpcValue& parameters) : name_(name)
{
  if (parameters.valid())
    flatten("", parameters);
}

void ParamReader::flatten(const std::string& prefix, const XmlRpcValue& value)
{
  if (value.getType() != XmlRpcValue::TypeStruct)
  {
    parameters_[prefix] = value;
    return;
  }
  XmlRpcValue map = value;
  for (auto& entry : map)
    flatten(prefix.empty() ? entry.first : prefix + "/" + entry.first, entry.second);
}

const XmlRpcValue* ParamReader::find(const std::string& key)
{
  const auto found = parameters_.find(key);
  return found == parameters_.end() ? nullptr : &found->second;
}

void ParamReader::wrongType(const std::string& key, const XmlRpcValue& value, const std::string& expected)
{
  violations_.push_back(key + " = " + textOf(value) + ": must be " + expected + ", is a " + typeName(value));
}

void ParamReader::read(const std::string& key, bool& value)
{
  if (const XmlRpcValue* given = find(key))
  {
    if (given->getType() == XmlRpcValue::TypeBoolean)
      value = as<bool>(*given);
    else
      wrongType(key, *given, "true or false");
  }
  effective_[key] = value ? "true" : "false";
}

void ParamReader::read(const std::string& key, int& value)
{
  if (const XmlRpcValue* given = find(key))
  {
    if (given->getType() == XmlRpcValue::TypeInt)
      value = as<int>(*given);
    else
      wrongType(key, *given, "an integer");
  }
  effective_[key] = std::to_string(value);
}

void ParamReader::read(const std::string& key, std::uint64_t& value)
{
  if (const XmlRpcValue* given = find(key))
  {
    if (given->getType() == XmlRpcValue::TypeInt && as<int>(*given) >= 0)
      value = static_cast<std::uint64_t>(as<int>(*given));
    else
      wrongType(key, *given, "an integer of at least 0");
  }
  effective_[key] = std::to_string(value);
}

void ParamReader::read(const std::string& key, double& value)
{
  if (const XmlRpcValue* given = find(key))
  {
    if (given->getType() == XmlRpcValue::TypeDouble)
      value = as<double>(*given);
    else if (given->getType() == XmlRpcValue::TypeInt)
      value = as<int>(*given);
    else
      wrongType(key, *given, "a number");
  }
  std::ostringstream text;
  text << value;
  effective_[key] = text.str();
}

void ParamReader::read(const std::string& key, std::string& value)
{
  if (const XmlRpcValue* given = find(key))
  {
    if (given->getType() == XmlRpcValue::TypeString)
      value = as<std::string>(*given);
    else
      wrongType(key, *given, "a string");
  }
  effective_[key] = "\"" + value + "\"";
}

std::size_t ParamReader::readWord(const std::string& key, const std::vector<std::string>& words, std::size_t current)
{
  if (const XmlRpcValue* given = find(key))
  {
    if (given->getType() != XmlRpcValue::TypeString)
      wrongType(key, *given, "one of " + joined(words));
    else
    {
      const auto found = std::find(words.begin(), words.end(), as<std::string>(*given));
      if (found == words.end())
        violations_.push_back(key + " = \"" + as<std::string>(*given) + "\": must be one of " + joined(words));
      else
        current = static_cast<std::size_t>(found - words.begin());
    }
  }
  effective_[key] = words[current];
  return current;
}

void ParamReader::include(const std::vector<std::string>& violations)
{
  violations_.insert(violations_.end(), violations.begin(), violations.end());
}

void ParamReader::finish()
{
  std::vector<std::string> known;
  for (const auto& entry : effective_)
    known.push_back(entry.first);
  for (const auto& [key, value] : parameters_)
    if (effective_.count(key) == 0)
      violations_.push_back(key + " = " + textOf(value) + ": no such parameter; known are " + joined(known));
  if (!violations_.empty())
  {
    std::string message = "invalid parameters of " + name_ + ":";
    for (const std::string& violation : violations_)
      message += "\n  " + violation;
    throw base::Error(base::StatusCode::INVALID_ARGUMENT, message);
  }
  std::string values;
  for (const auto& [key, value] : effective_)
    values += "\n  " + key + ": " + value;
  ROS_INFO_STREAM("parameters of " << name_ << ":" << values);
}

}  // namespace object_modelling::ros_bridge
