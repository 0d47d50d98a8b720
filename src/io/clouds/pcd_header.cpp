#include "io/clouds/pcd_header.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

constexpr const char* kRemedy = "Write the file again as PCD 0.7";

std::optional<ScalarType> scalar_type(std::string_view letter, std::string_view size) {
  if (letter == "F" && size == "4") return ScalarType::kFloat32;
  if (letter == "F" && size == "8") return ScalarType::kFloat64;
  const bool is_signed = letter == "I";
  if (!is_signed && letter != "U") return std::nullopt;
  if (size == "1") return is_signed ? ScalarType::kInt8 : ScalarType::kUint8;
  if (size == "2") return is_signed ? ScalarType::kInt16 : ScalarType::kUint16;
  if (size == "4") return is_signed ? ScalarType::kInt32 : ScalarType::kUint32;
  if (size == "8") return is_signed ? ScalarType::kInt64 : ScalarType::kUint64;
  return std::nullopt;
}

class PcdHeaderParser {
 public:
  PcdHeaderParser(const std::filesystem::path& file, std::string_view text) : file_(file), lines_(text) {}

  PcdHeader parse() {
    while (const auto line = lines_.next()) {
      const std::vector<std::string_view> words = words_of(*line);
      if (words.empty() || words[0][0] == '#') continue;
      take(words);
      if (words[0] == "DATA") return finished();
    }
    if (lines_.number() == 0) fail("an empty file", "a PCD header");
    fail("the header ends without a DATA line", "DATA ascii, binary or binary_compressed");
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    const std::string where = lines_.number() > 0 ? at_line(lines_.number()) : "";
    throw IoError({file_, where, found, expected, kRemedy});
  }

  void take(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    if (key == "FIELDS" || key == "COLUMNS") {
      names_.assign(values.begin(), values.end());
    } else if (key == "SIZE") {
      sizes_ = values;
    } else if (key == "TYPE") {
      types_ = values;
    } else if (key == "COUNT") {
      take_counts(values);
    } else if (key == "WIDTH") {
      width_ = number(key, values);
    } else if (key == "HEIGHT") {
      height_ = number(key, values);
    } else if (key == "POINTS") {
      points_ = number(key, values);
    } else if (key == "DATA") {
      take_encoding(values);
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      fail(in_quotes(key),
           "a keyword of a PCD header (VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, POINTS, DATA)");
    }
  }

  std::size_t number(std::string_view key, const std::vector<std::string_view>& values) const {
    const auto value = values.size() == 1 ? parse_unsigned(values[0]) : std::nullopt;
    if (!value)
      fail(std::string(key) + " " + (values.empty() ? "without a value" : in_quotes(values[0])), "one whole number");
    return *value;
  }

  void take_counts(const std::vector<std::string_view>& values) {
    constexpr std::uint64_t kLargestCount = 1 << 20;
    counts_.clear();
    for (const std::string_view text : values) {
      const auto count = parse_unsigned(text);
      if (!count || *count < 1 || *count > kLargestCount)
        fail("COUNT " + in_quotes(text), "a number from 1 to 1048576");
      counts_.push_back(*count);
    }
  }

  void take_encoding(const std::vector<std::string_view>& values) {
    constexpr std::array<std::string_view, 3> kNames{"ascii", "binary", "binary_compressed"};  // as PcdEncoding
    const std::string_view name = values.size() == 1 ? values[0] : std::string_view();
    const auto known = std::find(kNames.begin(), kNames.end(), name);
    if (known == kNames.end()) fail("DATA " + in_quotes(name), "DATA ascii, binary or binary_compressed");
    header_.encoding = static_cast<PcdEncoding>(known - kNames.begin());
  }

  PcdHeader finished() {
    const std::size_t n = names_.size();
    if (n == 0) fail("no FIELDS before DATA", "FIELDS x y z …");
    if (counts_.empty()) counts_.assign(n, 1);
    if (sizes_.size() != n || types_.size() != n || counts_.size() != n) {
      fail(std::to_string(n) + " FIELDS, " + std::to_string(sizes_.size()) + " SIZE, " + std::to_string(types_.size()) +
               " TYPE, " + std::to_string(counts_.size()) + " COUNT",
           "as many of each");
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto type = scalar_type(types_[i], sizes_[i]);
      if (!type) {
        fail("field " + in_quotes(names_[i]) + " with TYPE " + in_quotes(types_[i]) + " and SIZE " +
                 in_quotes(sizes_[i]),
             "I or U with 1, 2, 4, 8 or F with 4, 8");
      }
      header_.fields.push_back({std::string(names_[i]), *type, counts_[i]});
    }
    header_.points = agreed_points();
    header_.body_offset = lines_.offset();
    header_.lines = lines_.number();
    return header_;
  }

  std::size_t agreed_points() const {
    std::size_t product = 0;
    const bool overflow = __builtin_mul_overflow(width_.value_or(0), height_.value_or(1), &product);
    if (!width_ && !points_) fail("neither WIDTH nor POINTS before DATA", "the number of points");
    if (overflow || (width_ && points_ && product != *points_)) {
      fail("WIDTH " + std::to_string(*width_) + " × HEIGHT " + std::to_string(height_.value_or(1)) +
               (points_ ? " and POINTS " + std::to_string(*points_) : ""),
           "WIDTH × HEIGHT = POINTS");
    }
    return points_.value_or(product);
  }

  const std::filesystem::path& file_;
  LineScanner lines_;
  PcdHeader header_;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> sizes_;
  std::vector<std::string_view> types_;
  std::vector<std::size_t> counts_;
  std::optional<std::size_t> width_;
  std::optional<std::size_t> height_;
  std::optional<std::size_t> points_;
};

}  // namespace

std::size_t PcdHeader::point_bytes() const {
  std::size_t bytes = 0;
  for (const Field& field : fields) bytes += field.bytes();
  return bytes;
}

PcdHeader parse_pcd_header(const std::filesystem::path& file, std::string_view text) {
  return PcdHeaderParser(file, text).parse();
}

}  // namespace rilo::detail
