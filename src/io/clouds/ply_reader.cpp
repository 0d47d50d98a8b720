// PLY: ascii, binary little and big endian. Only the element "vertex" is kept; what comes before it is skipped.
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "io/byte_cursor.hpp"
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
    throw IoError({file.path, position, found, expected, kCutOff});
  }
};

// So many rows cannot be in fewer bytes than this.
void check_count(const PlyBody& body, const PlyElement& element, std::size_t least_bytes, std::size_t present) {
  if (least_bytes == 0 || element.count <= present / least_bytes) return;
  body.fail("byte " + std::to_string(body.file.size - present),
            "element " + in_quotes(element.name) + " with " + counted(element.count, "row") + " and " +
                counted(present, "byte") + " left",
            "at least " + counted(least_bytes, "byte") + " a row");
}

// Each value of a list takes a byte at least.
std::size_t take_length(const PlyBody& body, ByteCursor& cursor, ScalarType type) {
  const char* place = cursor.take_bytes(size_of(type), "a list's length").data();
  const double length = read_value({place, 0, type, body.big_endian()});
  if (length >= 0 && length <= static_cast<double>(cursor.left())) return static_cast<std::size_t>(length);
  body.fail("byte " + std::to_string(body.header.body_offset + cursor.offset() - size_of(type)),
            fmt::format("a list of {:.0f} values", length),
            "0 or more, and at most one for each of the " + counted(cursor.left(), "byte") + " left");
}

// One row; `rows` is null for an element that is skipped.
void walk_binary_row(const PlyBody& body, ByteCursor& cursor, const PlyElement& element, PackedRows* rows) {
  if (rows != nullptr) rows->add_row();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::size_t count = property.list_count ? take_length(body, cursor, *property.list_count) : 1;
    const char* value = cursor.take_bytes(count * size_of(property.type), "a row").data();
    if (rows != nullptr && rows->wanted(i)) rows->store_bytes(i, value);
  }
}

void pass_over_binary(const PlyBody& body, ByteCursor& cursor, const PlyElement& element) {
  check_count(body, element, element.least_bytes(), cursor.left());
  if (!element.has_list()) {
    cursor.take_bytes(element.count * element.least_bytes(), "rows");
    return;
  }
  for (std::size_t i = 0; i < element.count; ++i) walk_binary_row(body, cursor, element, nullptr);
}

RawCloud read_binary_vertices(const PlyBody& body, ByteCursor& cursor, const PlyElement& vertex,
                              const FieldRoles& roles) {
  const std::vector<Field> fields = vertex.fields();
  const std::size_t stride = vertex.least_bytes();
  check_count(body, vertex, stride, cursor.left());
  if (vertex.has_list()) {
    PackedRows rows(fields, roles);
    for (std::size_t i = 0; i < vertex.count; ++i) walk_binary_row(body, cursor, vertex, &rows);
    return assemble_cloud(fields, roles, rows.columns(body.big_endian()), vertex.count);
  }
  const char* place = cursor.take_bytes(vertex.count * stride, "rows").data();
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
            "the end after " + counted(row, "row") + " of element " + in_quotes(element.name),
            counted(element.count, "row"));
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
  const std::vector<Field> fields = vertex.fields();
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
  const detail::BytesOrigin origin{file};
  const detail::FieldRoles roles = detail::find_roles(vertex.fields(), time_field, origin);
  if (header.encoding == detail::PlyEncoding::kAscii) return detail::read_ascii(body, vertex, roles);
  detail::ByteCursor cursor(body.bytes(), origin, header.body_offset);
  for (const detail::PlyElement& element : header.elements) {
    if (&element == &vertex) break;
    detail::pass_over_binary(body, cursor, element);
  }
  return detail::read_binary_vertices(body, cursor, vertex, roles);
}

}  // namespace rilo
