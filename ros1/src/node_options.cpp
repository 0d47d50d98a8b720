#include "node_options.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <ros/node_handle.h>
#include <stdexcept>
#include <string>
#include <vector>

#include "rilo/node/node_parameters.hpp"

namespace rilo::ros1 {
namespace {

double number_of(XmlRpc::XmlRpcValue& value, const std::string& name) {
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) return static_cast<int>(value);
  if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) return static_cast<double>(value);
  throw std::invalid_argument("parameter " + name + ": expected a list of numbers");
}

ParameterValue value_of(XmlRpc::XmlRpcValue& value, const std::string& name) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value);
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::int64_t{static_cast<int>(value)};
    case XmlRpc::XmlRpcValue::TypeDouble:
      return static_cast<double>(value);
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeArray: {
      std::vector<double> list;
      for (int i = 0; i < value.size(); ++i) list.push_back(number_of(value[i], name));
      return list;
    }
    default:
      throw std::invalid_argument("parameter " + name + ": expected a single value or a list of numbers");
  }
}

}  // namespace

NodeOptions read_options(const ros::NodeHandle& node) {
  std::vector<std::string> names;
  node.getParamNames(names);
  const std::string own = node.getNamespace() + "/";
  std::map<std::string, ParameterValue> given;
  for (const std::string& full : names) {
    if (full.rfind(own, 0) != 0) continue;
    std::string name = full.substr(own.size());
    XmlRpc::XmlRpcValue value;
    node.getParam(name, value);
    std::replace(name.begin(), name.end(), '/', '.');  // as the configuration writes it
    given.emplace(name, value_of(value, name));
  }
  return node_options(given);
}

}  // namespace rilo::ros1
