#include "io/clouds/ply_header.hpp"

#include <algorithm>
#include <array>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

// The old names; a type goes by to_string() as well. In the order of ScalarType.
constexpr std::array<std::string_view, 10> kOldNames{"char", "uchar", "short", "ushort", "int",
                                                     "uint", "",      "",      "float",  "double"};

class PlyHeaderParser {
 public:
  PlyHeaderParser(const std::filesystem::path& file, std::string_view text) : file_(file), lines_(text) {}

  PlyHeader parse() {
    const auto magic = lines_.next();
    if (!magic || trimmed(*magic) != "ply") fail(magic ? in_quotes(*magic) : "an empty file", "ply in the first line");
    while (const auto line = lines_.next()) {
      const std::vector<std::string_view> words = words_of(*line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return finished();
      take(words);
    }
    fail("the header ends without end_header", "end_header");
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw IoError({file_, at_line(lines_.number()), found, expected, "Write the file again as PLY 1.0"});
  }

  void take(const std::vector<std::string_view>& words) {
    if (words[0] == "format") {
      take_format(words);
    } else if (words[0] == "element") {
      take_element(words);
    } else if (words[0] == "property") {
      take_property(words);
    } else {
      fail(in_quotes(words[0]), "format, comment, element, property or end_header");
    }
  }

  void take_format(const std::vector<std::string_view>& words) {
    constexpr std::array<std::string_view, 3> kNames{"ascii", "binary_little_endian", "binary_big_endian"};
    const std::string_view name = words.size() == 3 ? words[1] : std::string_view();
    const auto known = std::find(kNames.begin(), kNames.end(), name);
    if (known == kNames.end()) {
      fail("format " + in_quotes(name), "format ascii, binary_little_endian or binary_big_endian, and 1.0");
    }
    header_.encoding = static_cast<PlyEncoding>(known - kNames.begin());  // in the same order
    has_format_ = true;
  }

  void take_element(const std::vector<std::string_view>& words) {
    const auto count = words.size() == 3 ? parse_unsigned(words[2]) : std::nullopt;
    if (!count) fail("an element line without a count", "element NAME COUNT");
    header_.elements.push_back({std::string(words[1]), *count, {}});
  }

  void take_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element", "element NAME COUNT");
    PlyProperty property;
    if (words.size() == 5 && words[1] == "list") {
      property = {std::string(words[4]), type_of(words[3]), type_of(words[2])};
      if (is_floating(*property.list_count)) fail("a list whose length is " + in_quotes(words[2]), "an integer type");
    } else if (words.size() == 3) {
      property = {std::string(words[2]), type_of(words[1]), std::nullopt};
    } else {
      fail("a property line of " + counted(words.size(), "word"),
           "property TYPE NAME, or property list TYPE TYPE NAME");
    }
    header_.elements.back().properties.push_back(property);
  }

  ScalarType type_of(std::string_view name) const {
    for (std::size_t i = 0; i < kOldNames.size(); ++i) {
      const auto type = static_cast<ScalarType>(i);
      if (name == kOldNames[i] || name == to_string(type)) return type;
    }
    fail("the type " + in_quotes(name), "char, uchar, short, ushort, int, uint, float or double");
  }

  PlyHeader finished() {
    if (!has_format_) fail("a header without a format line", "format ascii, binary_little_endian or binary_big_endian");
    header_.body_offset = lines_.offset();
    header_.lines = lines_.number();
    return header_;
  }

  const std::filesystem::path& file_;
  LineScanner lines_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::vector<Field> PlyElement::fields() const {
  std::vector<Field> fields;
  for (const PlyProperty& property : properties) {
    fields.push_back({property.list_count ? "(list)" : property.name, property.type, 1});
  }
  return fields;
}

bool PlyElement::has_list() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.list_count.has_value(); });
}

std::size_t PlyElement::least_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) bytes += size_of(property.list_count.value_or(property.type));
  return bytes;
}

PlyHeader parse_ply_header(const std::filesystem::path& file, std::string_view text) {
  return PlyHeaderParser(file, text).parse();
}

}  // namespace rilo::detail
