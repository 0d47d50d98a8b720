#include "settings.hpp"

#include <algorithm>
#include <cstddef>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "rilo/config/calibration_file.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo::python {

namespace py = pybind11;

namespace {

std::string value_text(const std::string& key, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) {
    // Python's shortest form; its nan and inf have a dot before them in YAML.
    return py::str(value).cast<std::string>();
  }
  if (py::hasattr(value, "dtype") && py::len(value.attr("shape")) == 0) {
    return value_text(key, value.attr("item")());  // numpy's numbers
  }
  refuse_type(key, value, "a number, a bool or text");
}

bool is_mapping(const py::handle& value) {
  return py::isinstance(value, py::module_::import("collections.abc").attr("Mapping"));
}

constexpr std::ptrdiff_t kDeepestKey = 3;  // dots of a key; a dict may hold itself

void flatten(const std::string& prefix, const py::dict& values, std::vector<std::string>& settings) {
  if (std::count(prefix.begin(), prefix.end(), '.') > kDeepestKey) {
    throw py::type_error("settings: nested too deep at " + prefix.substr(0, prefix.size() - 1));
  }
  for (const auto& [name, value] : values) {
    if (!py::isinstance<py::str>(name)) refuse_type("settings", name, "keys that are text");
    const std::string key = prefix + name.cast<std::string>();
    if (is_mapping(value)) {
      flatten(key + ".", py::dict(py::reinterpret_borrow<py::object>(value)), settings);
    } else {
      settings.push_back(key + "=" + value_text(key, value));
    }
  }
}

std::vector<std::string> texts_of(const py::object& settings) {
  if (settings.is_none()) return {};
  std::vector<std::string> texts;
  if (is_mapping(settings)) {
    flatten("", py::dict(settings), texts);
    return texts;
  }
  constexpr const char* kExpected = "a dict or a list of \"key=value\"";
  if (py::isinstance<py::str>(settings) || !py::isinstance<py::sequence>(settings)) {
    refuse_type("settings", settings, kExpected);
  }
  for (const py::handle& text : settings) {
    if (!py::isinstance<py::str>(text)) refuse_type("settings", text, "\"key=value\"");
    texts.push_back(text.cast<std::string>());
  }
  return texts;
}

constexpr const char* kConfigExpected = "a dict, YAML text or the path of a YAML file";

struct GivenYaml {
  std::string text;
  bool is_path = false;  // the text is one
};

GivenYaml yaml_of(const py::object& given, const char* name, const char* expected) {
  if (py::hasattr(given, "__fspath__")) return {given.cast<std::filesystem::path>().string(), true};
  if (!py::isinstance<py::str>(given)) refuse_type(name, given, expected);
  const auto text = given.cast<std::string>();
  // Keys have a colon behind them.
  const bool is_path = text.ends_with(".yaml") || text.ends_with(".yml") || text.find(':') == std::string::npos;
  return {text, is_path && !text.empty()};
}

OdometryConfig base_of(const py::object& config) {
  if (config.is_none()) return {};
  if (is_mapping(config)) return with_overrides({}, texts_of(config), "config");
  const auto given = yaml_of(config, "config", kConfigExpected);
  return given.text.empty() ? OdometryConfig{} : parse_config(given.text, "config");
}

}  // namespace

OdometryConfig config_of(const py::object& config, const py::object& settings) {
  if (!config.is_none() && !is_mapping(config)) {
    const auto given = yaml_of(config, "config", kConfigExpected);
    if (given.is_path) return load_config(given.text, texts_of(settings), "settings");
  }
  return with_overrides(base_of(config), texts_of(settings), "settings");
}

std::optional<SensorAngles> calibration_of(const py::object& calibration) {
  if (calibration.is_none()) return std::nullopt;
  const auto given = yaml_of(calibration, "calibration", "YAML text or the path of a YAML file");
  return given.is_path ? load_calibration(given.text) : parse_calibration(given.text, "calibration");
}

}  // namespace rilo::python
