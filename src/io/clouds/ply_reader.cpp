// PLY: ascii, binary little and big endian. Only the element "vertex" is kept; what comes before it is skipped.
#include <algorithm>
#include <string>

#include "io/clouds/cloud_columns.hpp"
#include "io/clouds/ply_header.hpp"
#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace detail {
namespace {

struct PlyBody {
  const FileBytes& file;
  const PlyHeader& header;

  std::string_view bytes() const { return file.view().substr(header.body_offset); }
  bool big_endian() const { return header.encoding == PlyEncoding::kBinaryBigEndian; }

  [[noreturn]] void fail(const std::string& position, const std::string& found, const std::string& expected) const {
    throw IoError(
        {file.path, position, found, expected, "The file is cut off or its header is wrong: copy or write it again"});
  }
};

// So many rows cannot be in fewer bytes than this.
void check_count(const PlyBody& body, const PlyElement& element, std::size_t least_bytes, std::size_t present) {
  if (least_bytes == 0 || element.count <= present / least_bytes) return;
  body.fail("byte " + std::to_string(body.file.size - present),
            "element " + in_quotes(element.name) + " with " + std::to_string(element.count) + " rows and " +
                std::to_string(present) + " bytes left",
            "at least " + std::to_string(least_bytes) + " bytes a row");
}

std::vector<Field> fields_of(const PlyElement& vertex) {
  std::vector<Field> fields;
  for (const PlyProperty& property : vertex.properties) {
    // A list is not a column: its name must not be taken for one.
    fields.push_back({property.list_count ? "(list)" : property.name, property.type, 1});
  }
  return fields;
}

// Walks through binary rows of varying length.
class BinaryCursor {
 public:
  explicit BinaryCursor(const PlyBody& body) : body_(body), bytes_(body.bytes()) {}

  std::size_t left() const { return bytes_.size() - offset_; }

  const char* take(std::size_t count, std::size_t size) {
    std::size_t total = 0;
    if (__builtin_mul_overflow(count, size, &total) || total > left()) {
      body_.fail("byte " + std::to_string(body_.header.body_offset + offset_), "the end of the file inside a row",
                 std::to_string(count) + " values of " + std::to_string(size) + " bytes");
    }
    const char* place = bytes_.data() + offset_;
    offset_ += total;
    return place;
  }

  /// A list's length.
  std::size_t take_length(ScalarType type) {
    const std::size_t size = size_of(type);
    const char* place = take(1, size);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t digit = body_.big_endian() ? size - 1 - i : i;
      value |= std::uint64_t{static_cast<unsigned char>(place[digit])} << (8 * i);
    }
    const bool is_signed = type == ScalarType::kInt8 || type == ScalarType::kInt16 || type == ScalarType::kInt32 ||
                           type == ScalarType::kInt64;
    if (is_signed && (value >> (8 * size - 1)) != 0) {
      body_.fail("byte " + std::to_string(body_.header.body_offset + offset_ - size), "a negative length of a list",
                 "0 or more");
    }
    return value;
  }

 private:
  const PlyBody& body_;
  std::string_view bytes_;
  std::size_t offset_ = 0;
};

// One row; `rows` is null for an element that is skipped.
void walk_binary_row(BinaryCursor& cursor, const PlyElement& element, PackedRows* rows) {
  if (rows != nullptr) rows->add_row();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::size_t count = property.list_count ? cursor.take_length(*property.list_count) : 1;
    const char* value = cursor.take(count, size_of(property.type));
    if (rows != nullptr && rows->wanted(i)) rows->store_bytes(i, value);
  }
}

void pass_over_binary(const PlyBody& body, BinaryCursor& cursor, const PlyElement& element) {
  check_count(body, element, element.least_bytes(), cursor.left());
  if (!element.has_list()) {
    cursor.take(element.count, element.least_bytes());
    return;
  }
  for (std::size_t i = 0; i < element.count; ++i) walk_binary_row(cursor, element, nullptr);
}

RawCloud read_binary_vertices(const PlyBody& body, BinaryCursor& cursor, const PlyElement& vertex,
                              const FieldRoles& roles) {
  const std::vector<Field> fields = fields_of(vertex);
  const std::size_t stride = vertex.least_bytes();
  check_count(body, vertex, stride, cursor.left());
  if (vertex.has_list()) {
    PackedRows rows(fields, roles);
    for (std::size_t i = 0; i < vertex.count; ++i) walk_binary_row(cursor, vertex, &rows);
    return assemble_cloud(fields, roles, rows.columns(body.big_endian()), vertex.count);
  }
  const char* place = cursor.take(vertex.count, stride);
  std::vector<ColumnView> columns;
  for (const Field& field : fields) {
    columns.push_back({place, stride, field.type, body.big_endian()});
    place += field.bytes();
  }
  return assemble_cloud(fields, roles, columns, vertex.count);
}

std::string_view next_row(const PlyBody& body, LineScanner& lines, const PlyElement& element, std::size_t row) {
  while (const auto line = lines.next()) {
    if (!trimmed(*line).empty()) return *line;
  }
  body.fail(at_line(body.header.lines + lines.number()),
            "the end after " + std::to_string(row) + " rows of element " + in_quotes(element.name),
            std::to_string(element.count) + " rows");
}

void read_ascii_row(const PlyBody& body, std::string_view line, std::size_t number, const PlyElement& vertex,
                    PackedRows& rows) {
  WordScanner words(line);
  rows.add_row();
  const auto need_word = [&]() {
    const auto word = words.next();
    if (!word) body.fail(at_line(number), "too few values", "a value for every property");
    return *word;
  };
  for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
    const PlyProperty& property = vertex.properties[i];
    if (property.list_count) {
      const auto length = parse_unsigned(need_word());
      // Every value takes a character of the line: need_word() ends a lying length.
      if (!length)
        body.fail(at_line(number, words.column()), "no length of list " + in_quotes(property.name), "a whole number");
      for (std::size_t k = 0; k < *length; ++k) need_word();
      continue;
    }
    const std::string_view word = need_word();
    if (rows.wanted(i) && !rows.store_text(i, word)) {
      body.fail(at_line(number, words.column()), in_quotes(word),
                "a number (" + std::string(to_string(property.type)) + ") for property " + property.name);
    }
  }
  if (words.next()) body.fail(at_line(number, words.column()), "more values", "the properties of the header");
}

RawCloud read_ascii(const PlyBody& body, const PlyElement& vertex, const FieldRoles& roles) {
  LineScanner lines(body.bytes());
  for (const PlyElement& element : body.header.elements) {
    // A row without properties has no line.
    const std::size_t least = 2 * element.properties.size();
    check_count(body, element, least, body.bytes().size() - lines.offset() + 1);
    if (&element == &vertex) break;
    for (std::size_t row = 0; least > 0 && row < element.count; ++row) next_row(body, lines, element, row);
  }
  const std::vector<Field> fields = fields_of(vertex);
  PackedRows rows(fields, roles);
  for (std::size_t row = 0; row < vertex.count; ++row) {
    const std::string_view line = next_row(body, lines, vertex, row);
    read_ascii_row(body, line, body.header.lines + lines.number(), vertex, rows);
  }
  while (&vertex == &body.header.elements.back()) {
    const auto line = lines.next();
    if (!line) break;
    if (trimmed(*line).empty()) continue;
    body.fail(at_line(body.header.lines + lines.number()), "another row",
              "the end of the file after " + std::to_string(vertex.count) + " vertices");
  }
  return assemble_cloud(fields, roles, rows.columns(false), vertex.count);
}

const PlyElement& vertex_of(const PlyBody& body) {
  const auto& elements = body.header.elements;
  const auto found =
      std::find_if(elements.begin(), elements.end(), [](const PlyElement& e) { return e.name == "vertex"; });
  if (found == elements.end()) {
    body.fail(at_line(body.header.lines), "no element 'vertex'", "element vertex COUNT with properties x, y and z");
  }
  return *found;
}

}  // namespace
}  // namespace detail

RawCloud read_ply(const std::filesystem::path& file, const std::string& time_field) {
  const detail::FileBytes bytes = detail::read_file(file);
  const detail::PlyHeader header = detail::parse_ply_header(file, bytes.view());
  const detail::PlyBody body{bytes, header};
  const detail::PlyElement& vertex = detail::vertex_of(body);
  const detail::FieldRoles roles = detail::find_roles(detail::fields_of(vertex), time_field, file);
  if (header.encoding == detail::PlyEncoding::kAscii) return detail::read_ascii(body, vertex, roles);
  detail::BinaryCursor cursor(body);
  for (const detail::PlyElement& element : header.elements) {
    if (&element == &vertex) break;
    detail::pass_over_binary(body, cursor, element);
  }
  return detail::read_binary_vertices(body, cursor, vertex, roles);
}

}  // namespace rilo
