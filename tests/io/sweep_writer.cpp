#include "io/sweep_writer.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "io/atomic_file.hpp"
#include "io/raw_bytes.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

void append_literals(std::string& output, std::string_view literals) {
  constexpr std::size_t kLongest = 32;
  for (; !literals.empty(); literals.remove_prefix(std::min(kLongest, literals.size()))) {
    output += static_cast<char>(std::min(kLongest, literals.size()) - 1);
    output += literals.substr(0, kLongest);
  }
}

// One column: its name, its type and how to write value i, as text or as bytes.
struct Column {
  std::string name;
  bool is_float = true;  // float32, else uint16
  std::function<float(std::size_t)> number;

  std::size_t bytes() const { return is_float ? sizeof(float) : sizeof(std::uint16_t); }
};

std::vector<Column> columns_of(const Sweep& sweep) {
  const std::size_t n = sweep.points.size();
  const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
  if (!fits(sweep.times_s.size()) || !fits(sweep.intensities.size()) || !fits(sweep.rings.size())) {
    throw std::invalid_argument("the columns of a sweep must be empty or as long as its points");
  }
  std::vector<Column> columns;
  columns.push_back({"x", true, [&](std::size_t i) { return sweep.points[i].x(); }});
  columns.push_back({"y", true, [&](std::size_t i) { return sweep.points[i].y(); }});
  columns.push_back({"z", true, [&](std::size_t i) { return sweep.points[i].z(); }});
  if (!sweep.intensities.empty()) {
    columns.push_back({"intensity", true, [&](std::size_t i) { return sweep.intensities[i]; }});
  }
  if (!sweep.times_s.empty()) columns.push_back({"time", true, [&](std::size_t i) { return sweep.times_s[i]; }});
  if (!sweep.rings.empty()) {
    columns.push_back({"ring", false, [&](std::size_t i) { return static_cast<float>(sweep.rings[i]); }});
  }
  return columns;
}

void append_value(std::string& bytes, const Column& column, std::size_t i, bool big_endian) {
  const float value = column.number(i);
  if (column.is_float) {
    detail::append_bytes(bytes, value, big_endian);
  } else {
    detail::append_bytes(bytes, static_cast<std::uint16_t>(value), big_endian);
  }
}

// Row after row; the text form keeps every bit of a float32.
std::string rows_of(const std::vector<Column>& columns, std::size_t count, bool text, bool big_endian) {
  std::string rows;
  for (std::size_t i = 0; i < count; ++i) {
    for (const Column& column : columns) {
      if (text) {
        fmt::format_to(std::back_inserter(rows), "{:.9g}{}", column.number(i), &column == &columns.back() ? '\n' : ' ');
      } else {
        append_value(rows, column, i, big_endian);
      }
    }
  }
  return rows;
}

std::string compressed_columns(const std::filesystem::path& file, const std::vector<Column>& columns,
                               std::size_t count) {
  std::string plain;
  for (const Column& column : columns) {
    for (std::size_t i = 0; i < count; ++i) append_value(plain, column, i, false);
  }
  const std::string packed = lzf_compress(plain);
  constexpr std::size_t kLargest = 0xFFFFFFFF;
  if (std::max(plain.size(), packed.size()) > kLargest) {
    throw IoError(
        {file, "", std::to_string(count) + " points", "at most 4 GiB in a compressed PCD", "Write it as binary PCD"});
  }
  std::string bytes;
  detail::append_bytes(bytes, static_cast<std::uint32_t>(packed.size()));
  detail::append_bytes(bytes, static_cast<std::uint32_t>(plain.size()));
  return bytes + packed;
}

std::string joined(const std::vector<Column>& columns, const std::function<std::string(const Column&)>& word) {
  std::string text;
  for (const Column& column : columns) text += fmt::format(" {}", word(column));
  return text;
}

}  // namespace

void write_kitti_bin(const std::filesystem::path& file, const Sweep& sweep) {
  columns_of(sweep);  // checks the lengths
  std::string bytes;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    for (const float value : sweep.points[i]) detail::append_bytes(bytes, value);
    detail::append_bytes(bytes, sweep.intensities.empty() ? 0.0F : sweep.intensities[i]);
  }
  write_atomically(file, bytes);
}

void write_floats(const std::filesystem::path& file, const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) detail::append_bytes(bytes, value);
  write_atomically(file, bytes);
}

void write_pcd(const std::filesystem::path& file, const Sweep& sweep, PcdEncoding encoding) {
  const std::vector<Column> columns = columns_of(sweep);
  const std::size_t count = sweep.points.size();
  std::string text = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS";
  text += joined(columns, [](const Column& c) { return c.name; }) + "\nSIZE";
  text += joined(columns, [](const Column& c) { return std::to_string(c.bytes()); }) + "\nTYPE";
  text += joined(columns, [](const Column& c) { return std::string(c.is_float ? "F" : "U"); }) + "\nCOUNT";
  text += joined(columns, [](const Column&) { return std::string("1"); });
  text += fmt::format("\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA ", count);
  switch (encoding) {
    case PcdEncoding::kAscii:
      text += "ascii\n" + rows_of(columns, count, true, false);
      break;
    case PcdEncoding::kBinary:
      text += "binary\n" + rows_of(columns, count, false, false);
      break;
    case PcdEncoding::kBinaryCompressed:
      text += "binary_compressed\n" + compressed_columns(file, columns, count);
      break;
  }
  write_atomically(file, text);
}

void write_ply(const std::filesystem::path& file, const Sweep& sweep, PlyEncoding encoding) {
  const std::vector<Column> columns = columns_of(sweep);
  const bool text = encoding == PlyEncoding::kAscii;
  const bool big_endian = encoding == PlyEncoding::kBinaryBigEndian;
  std::string bytes =
      fmt::format("ply\nformat {} 1.0\ncomment Rilo sweep\nelement vertex {}\n",
                  text ? "ascii" : (big_endian ? "binary_big_endian" : "binary_little_endian"), sweep.points.size());
  for (const Column& column : columns) {
    bytes += fmt::format("property {} {}\n", column.is_float ? "float" : "ushort", column.name);
  }
  bytes += "end_header\n" + rows_of(columns, sweep.points.size(), text, big_endian);
  write_atomically(file, bytes);
}

std::string lzf_compress(std::string_view input) {
  constexpr std::size_t kLongestCopy = 264;
  constexpr std::size_t kLongestDistance = 8192;
  constexpr std::size_t kShortestCopy = 3;
  std::string output;
  std::unordered_map<std::string_view, std::size_t> last;  // where three bytes were seen
  std::size_t literals = 0;
  for (std::size_t place = 0; place + kShortestCopy <= input.size();) {
    const auto [seen, fresh] = last.try_emplace(input.substr(place, kShortestCopy), place);
    const std::size_t distance = place - std::exchange(seen->second, place);
    if (fresh || distance > kLongestDistance) {
      ++place;
      continue;
    }
    const std::string_view rest = input.substr(place, kLongestCopy);
    const auto end =
        std::mismatch(rest.begin(), rest.end(), input.begin() + static_cast<std::ptrdiff_t>(place - distance));
    const auto length = static_cast<std::size_t>(end.first - rest.begin());
    append_literals(output, input.substr(literals, place - literals));
    output += static_cast<char>(std::min<std::size_t>(length - 2, 7) << 5 | (distance - 1) >> 8);
    if (length >= 9) output += static_cast<char>(length - 9);
    output += static_cast<char>((distance - 1) & 0xFF);
    place += length;
    literals = place;
  }
  append_literals(output, input.substr(literals));
  return output;
}

}  // namespace rilo
