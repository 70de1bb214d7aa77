#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <XmlRpcValue.h>

namespace object_modelling::test
{
/// A YAML file as rosparam would load it: integers, floating-point numbers, booleans, words, nested maps.
XmlRpc::XmlRpcValue loadYaml(const std::string& path);

/// Stands in for ParamReader where the keys and the values that they would be read into are of interest.
class FieldList
{
public:
  template <typename T>
  void read(const std::string& key, T& value)
  {
    fields[key] = XmlRpc::XmlRpcValue(convertible(value));
  }
  /// The word of the value.
  template <typename Enum>
  void read(const std::string& key, Enum& value, const std::vector<std::pair<std::string, Enum>>& words)
  {
    for (const auto& [word, meaning] : words)
      if (meaning == value)
        fields[key] = XmlRpc::XmlRpcValue(word);
  }
  void include(const std::vector<std::string>&) {}

  std::map<std::string, XmlRpc::XmlRpcValue> fields;

private:
  static bool convertible(bool value) { return value; }
  static int convertible(int value) { return value; }
  static int convertible(std::uint64_t value) { return static_cast<int>(value); }
  static double convertible(double value) { return value; }
  static std::string convertible(const std::string& value) { return value; }
};

/// The leaves of nested maps, keys joined by '/'.
std::map<std::string, XmlRpc::XmlRpcValue> leaves(const XmlRpc::XmlRpcValue& map);

}  // namespace object_modelling::test
