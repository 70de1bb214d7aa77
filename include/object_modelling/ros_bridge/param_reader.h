#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

namespace object_modelling::ros_bridge
{
/// Reads a node's private parameters into options structs. An absent parameter leaves the default; a wrong type, an
/// unknown key and a broken bound are collected, so that a user mends all of them at once.
///
///   ParamReader reader(ros::NodeHandle("~"));
///   reader.read("tracker/seed", options.seed);
///   reader.include(options.violations());
///   reader.finish();
///
/// Keys of nested maps are joined by '/'. Not thread safe.
class ParamReader
{
public:
  explicit ParamReader(const ros::NodeHandle& private_node);
  /// For parameters that do not come from a parameter server; `name` stands for the node in messages.
  ParamReader(const std::string& name, const XmlRpc::XmlRpcValue& parameters);

  void read(const std::string& key, bool& value);
  void read(const std::string& key, int& value);
  void read(const std::string& key, std::uint64_t& value);
  void read(const std::string& key, double& value);
  void read(const std::string& key, std::string& value);
  /// One of a few words.
  template <typename Enum>
  void read(const std::string& key, Enum& value, const std::vector<std::pair<std::string, Enum>>& words);

  void include(const std::vector<std::string>& violations);

  /// Logs the effective values once, or throws base::Error (INVALID_ARGUMENT) that lists everything that is wrong.
  void finish();

private:
  const XmlRpc::XmlRpcValue* find(const std::string& key);
  void wrongType(const std::string& key, const XmlRpc::XmlRpcValue& value, const std::string& expected);
  void flatten(const std::string& prefix, const XmlRpc::XmlRpcValue& value);
  /// Index of the word read, or `current`.
  std::size_t readWord(const std::string& key, const std::vector<std::string>& words, std::size_t current);

  std::string name_;
  std::map<std::string, XmlRpc::XmlRpcValue> parameters_;  ///< by joined key
  std::map<std::string, std::string> effective_;
  std::vector<std::string> violations_;
};

template <typename Enum>
void ParamReader::read(const std::string& key, Enum& value, const std::vector<std::pair<std::string, Enum>>& words)
{
  std::vector<std::string> names;
  std::size_t current = 0;
  for (const auto& [word, meaning] : words)
  {
    if (meaning == value)
      current = names.size();
    names.push_back(word);
  }
  value = words[readWord(key, names, current)].second;
}

}  // namespace object_modelling::ros_bridge
