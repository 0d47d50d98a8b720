// PCD: ascii, binary, binary_compressed.
#include <memory>
#include <span>
#include <string>

#include "io/clouds/cloud_columns.hpp"
#include "io/clouds/lzf.hpp"
#include "io/clouds/pcd_header.hpp"
#include "io/file_bytes.hpp"
#include "io/raw_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace detail {
namespace {

struct PcdBody {
  const FileBytes& file;
  const PcdHeader& header;
  FieldRoles roles;

  std::string_view bytes() const { return file.view().substr(header.body_offset); }

  [[noreturn]] void fail(const std::string& position, const std::string& found, const std::string& expected) const {
    throw IoError({file.path, position, found, expected, kCutOff});
  }
  std::string position(std::size_t offset) const { return "byte " + std::to_string(header.body_offset + offset); }
};

// Each value takes a character and a separator: more points do not fit into these bytes.
void check_ascii_size(const PcdBody& body, std::size_t columns) {
  if (body.header.points <= (body.bytes().size() + 1) / (2 * columns)) return;
  body.fail(at_line(body.header.lines),
            "POINTS " + std::to_string(body.header.points) + " and " + counted(body.bytes().size(), "byte") +
                " of text after the header",
            "at least " + counted(2 * columns, "byte") + " a point");
}

// PCL once wrote numbers of one byte as that byte itself: Livox tags and lines are then control characters.
bool store(PackedRows& rows, const Field& field, std::size_t index, std::string_view word) {
  if (rows.store_text(index, word)) return true;
  if (field.type != ScalarType::kUint8 || word.size() != 1) return false;
  rows.store_bytes(index, word.data());
  return true;
}

void read_ascii_row(const PcdBody& body, std::string_view line, std::size_t number, PackedRows& rows) {
  WordScanner words(line);
  const std::vector<Field>& fields = body.header.fields;
  std::size_t column = 0;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    for (std::size_t k = 0; k < fields[i].count; ++k, ++column) {
      const auto word = words.next();
      if (!word) body.fail(at_line(number), counted(column, "value"), "a value for every field");
      if (k == 0 && rows.wanted(i) && !store(rows, fields[i], i, *word)) {
        body.fail(at_line(number, words.column()), in_quotes(*word),
                  "a number (" + std::string(to_string(fields[i].type)) + ") for field " + fields[i].name);
      }
    }
  }
  if (words.next())
    body.fail(at_line(number, words.column()), "more than " + counted(column, "value"), "the fields of the header");
}

RawCloud read_ascii(const PcdBody& body) {
  std::size_t columns = 0;
  for (const Field& field : body.header.fields) columns += field.count;
  check_ascii_size(body, columns);
  PackedRows rows(body.header.fields, body.roles);
  LineScanner lines(body.bytes());
  std::size_t count = 0;
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty()) continue;
    const std::size_t number = body.header.lines + lines.number();
    if (++count > body.header.points) {
      body.fail(at_line(number), "more points than POINTS " + std::to_string(body.header.points),
                "the end of the file");
    }
    rows.add_row();
    read_ascii_row(body, *line, number, rows);
  }
  if (count < body.header.points) {
    body.fail(at_line(body.header.lines + lines.number()), "the end after " + counted(count, "point"),
              "POINTS " + std::to_string(body.header.points));
  }
  return assemble_cloud(body.header.fields, body.roles, rows.columns(false), count);
}

std::size_t body_size(const PcdBody& body, std::size_t point_bytes) {
  std::size_t total = 0;
  if (__builtin_mul_overflow(body.header.points, point_bytes, &total)) {
    body.fail(at_line(body.header.lines), "POINTS " + std::to_string(body.header.points),
              "a number of points that can be");
  }
  return total;
}

RawCloud read_binary(const PcdBody& body) {
  const std::size_t point_bytes = body.header.point_bytes();
  const std::size_t needed = body_size(body, point_bytes);
  const std::size_t present = body.bytes().size();
  // Bytes behind the last point are padding of the writer.
  if (needed > present) {
    body.fail(
        body.position(0), counted(present, "byte") + " after the header",
        counted(body.header.points, "point") + " of " + counted(point_bytes, "byte") + " = " + counted(needed, "byte"));
  }
  std::vector<ColumnView> columns;
  const char* place = body.bytes().data();
  for (const Field& field : body.header.fields) {
    columns.push_back({place, point_bytes, field.type, false});
    place += field.bytes();
  }
  return assemble_cloud(body.header.fields, body.roles, columns, body.header.points);
}

FileBytes decompress(const PcdBody& body) {
  constexpr std::size_t kSizes = 8;
  const std::string_view bytes = body.bytes();
  if (bytes.size() < kSizes) {
    if (body.header.points == 0) return {};
    body.fail(body.position(0), counted(bytes.size(), "byte") + " after the header", "8 bytes with the two sizes");
  }
  const std::size_t packed = load_bytes<std::uint32_t>(bytes, 0);
  const std::size_t unpacked = load_bytes<std::uint32_t>(bytes, 4);
  if (packed > bytes.size() - kSizes) {
    body.fail(body.position(0), "a compressed size of " + counted(packed, "byte"),
              "at most the " + std::to_string(bytes.size() - kSizes) + " that follow");
  }
  if (unpacked > packed * kLzfLargestExpansion) {
    body.fail(body.position(4), "an uncompressed size of " + counted(unpacked, "byte"),
              "at most 88 times the compressed " + std::to_string(packed));
  }
  FileBytes result{body.file.path, std::make_unique_for_overwrite<char[]>(unpacked + 1), unpacked};
  const auto wrong = lzf_decompress(bytes.substr(kSizes, packed), std::span(result.data.get(), unpacked));
  if (wrong) {
    body.fail(body.position(kSizes + *wrong), "LZF data that does not give " + counted(unpacked, "byte"),
              "whole compressed data");
  }
  return result;
}

// Column after column. Some writers leave the padding fields, named _, out of the data, others do not.
RawCloud read_compressed(const PcdBody& body) {
  const FileBytes unpacked = decompress(body);
  std::size_t unpadded = 0;
  for (const Field& field : body.header.fields) unpadded += field.name == "_" ? 0 : field.bytes();
  const bool with_padding = unpacked.size == body_size(body, body.header.point_bytes());
  if (!with_padding && unpacked.size != body_size(body, unpadded)) {
    body.fail(body.position(4), "an uncompressed size of " + counted(unpacked.size, "byte"),
              counted(body.header.points, "point") + " of " + counted(body.header.point_bytes(), "byte"));
  }
  std::vector<ColumnView> columns;
  std::size_t place = 0;
  for (const Field& field : body.header.fields) {
    columns.push_back({unpacked.data.get() + place, field.bytes(), field.type, false});
    if (with_padding || field.name != "_") place += field.bytes() * body.header.points;
  }
  return assemble_cloud(body.header.fields, body.roles, columns, body.header.points);
}

}  // namespace
}  // namespace detail

RawCloud read_pcd(const std::filesystem::path& file, const std::string& time_field) {
  const detail::FileBytes bytes = detail::read_file(file);
  const detail::PcdHeader header = detail::parse_pcd_header(file, bytes.view());
  const detail::PcdBody body{bytes, header, detail::find_roles(header.fields, time_field, {file})};
  if (header.encoding == detail::PcdEncoding::kAscii) return detail::read_ascii(body);
  return header.encoding == detail::PcdEncoding::kBinary ? detail::read_binary(body) : detail::read_compressed(body);
}

}  // namespace rilo
