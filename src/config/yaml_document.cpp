#include "config/yaml_document.hpp"

#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>

#include "io/file_bytes.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo::detail {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 20;

/// Takes no notice of what a parser finds, but of where the last document begins.
class DocumentStart : public YAML::EventHandler {
 public:
  using Mark = YAML::Mark;
  using Anchor = YAML::anchor_t;
  using Style = YAML::EmitterStyle::value;
  void OnDocumentStart(const Mark& mark) override { place = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const Mark& /*mark*/, Anchor /*anchor*/) override {}
  void OnAlias(const Mark& /*mark*/, Anchor /*anchor*/) override {}
  void OnScalar(const Mark& /*mark*/, const std::string& /*tag*/, Anchor /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const Mark& /*mark*/, const std::string& /*tag*/, Anchor /*anchor*/, Style /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark& /*mark*/, const std::string& /*tag*/, Anchor /*anchor*/, Style /*style*/) override {}
  void OnMapEnd() override {}

  Mark place;
};

/// YAML::LoadAll would do, but at a stray comma it adds documents until memory runs out (yaml-cpp 0.7).
std::optional<YAML::Mark> second_document(std::string_view yaml) {
  std::istringstream stream{std::string(yaml)};
  YAML::Parser parser(stream);
  DocumentStart start;
  if (!parser.HandleNextDocument(start) || !parser.HandleNextDocument(start)) return std::nullopt;
  return start.place;
}

}  // namespace

std::string position_of(const YAML::Mark& mark) {
  if (mark.is_null()) return "";
  return "line " + std::to_string(mark.line + 1) + ", column " + std::to_string(mark.column + 1);
}

std::string quoted(const std::string& text) {
  return "\"" + (text.size() <= kLongestQuote ? text : text.substr(0, kLongestQuote) + "…") + "\"";
}

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map of keys";
  if (node.IsSequence()) return "a list";
  if (!node.IsScalar()) return "no value";
  return quoted(node.Scalar());
}

std::string read_yaml_file(const std::filesystem::path& file, const std::string& expected, const std::string& remedy) {
  if (!is_file(file)) {
    throw ConfigError({file, "", path_exists(file) ? "not a regular file" : "no such file", expected, remedy});
  }
  try {
    const FileBytes bytes = read_file(file, kLargestFile + 1);
    if (bytes.size > kLargestFile) throw IoError({file, "", "more than 1 MiB", expected, "Check the path"});
    return std::string(bytes.view());
  } catch (const IoError& error) {
    throw ConfigError(error.problem());
  }
}

YAML::Node parse_yaml(std::string_view yaml, const std::string& name, const std::string& hint) {
  try {
    if (const auto place = second_document(yaml)) {
      throw ConfigError({name, position_of(*place), "a second document", "one document", ""});
    }
    return YAML::Load(std::string(yaml));
  } catch (const YAML::Exception& error) {
    throw ConfigError(
        {name, position_of(error.mark), "not valid YAML (" + error.msg + ")", "\"key: value\" lines", hint});
  }
}

}  // namespace rilo::detail
