#include "settings.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <string>
#include <vector>

#include "rilo/config/config_file.hpp"

namespace rilo::python {

namespace py = pybind11;

namespace {

[[noreturn]] void reject(const std::string& name, const py::handle& value, const char* expected) {
  throw py::type_error(name + ": got " + py::repr(value).cast<std::string>() + " of type " +
                       py::str(py::type::of(value).attr("__name__")).cast<std::string>() + "; expected " + expected);
}

std::string value_text(const std::string& key, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) {
    // Python's shortest form; its nan and inf have a dot before them in YAML.
    return py::str(value).cast<std::string>();
  }
  if (py::hasattr(value, "item")) return value_text(key, value.attr("item")());  // numpy's numbers
  reject(key, value, "a number, a bool or text");
}

void flatten(const std::string& prefix, const py::dict& values, std::vector<std::string>& settings) {
  for (const auto& [name, value] : values) {
    if (!py::isinstance<py::str>(name)) reject("settings", name, "keys that are text");
    const std::string key = prefix + name.cast<std::string>();
    if (py::isinstance<py::dict>(value)) {
      flatten(key + ".", py::reinterpret_borrow<py::dict>(value), settings);
    } else {
      settings.push_back(key + "=" + value_text(key, value));
    }
  }
}

std::vector<std::string> texts_of(const py::object& settings) {
  if (settings.is_none()) return {};
  std::vector<std::string> texts;
  if (py::isinstance<py::dict>(settings)) {
    flatten("", py::reinterpret_borrow<py::dict>(settings), texts);
    return texts;
  }
  constexpr const char* kExpected = "a dict or a list of \"key=value\"";
  if (py::isinstance<py::str>(settings) || !py::isinstance<py::sequence>(settings)) {
    reject("settings", settings, kExpected);
  }
  for (const py::handle& text : settings) {
    if (!py::isinstance<py::str>(text)) reject("settings", text, "\"key=value\"");
    texts.push_back(text.cast<std::string>());
  }
  return texts;
}

OdometryConfig base_of(const py::object& config) {
  if (config.is_none()) return {};
  if (py::isinstance<py::dict>(config)) return with_overrides({}, texts_of(config), "config");
  if (py::hasattr(config, "__fspath__")) return load_config(config.cast<std::filesystem::path>());
  if (!py::isinstance<py::str>(config)) reject("config", config, "a dict, YAML text or the path of a YAML file");
  const auto text = config.cast<std::string>();
  if (text.ends_with(".yaml") || text.ends_with(".yml")) return load_config(text);
  return text.empty() ? OdometryConfig{} : parse_config(text, "config");
}

}  // namespace

OdometryConfig config_of(const py::object& config, const py::object& settings) {
  return with_overrides(base_of(config), texts_of(settings), "settings");
}

}  // namespace rilo::python
