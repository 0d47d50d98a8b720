#include "rilo/io/map_writer.hpp"

#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "io/atomic_file.hpp"
#include "io/raw_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

bool is_ply(const std::filesystem::path& file) {
  const std::string extension = detail::lower_case(file.extension().string());
  if (extension != ".ply" && extension != ".pcd") {
    throw IoError({file, "", "the extension " + detail::in_quotes(file.extension().string()), ".ply or .pcd",
                   "Give the map a name that ends so"});
  }
  return extension == ".ply";
}

}  // namespace

MapWriter::MapWriter(const std::filesystem::path& file, MapColumns columns)
    : ply_(is_ply(file)), columns_(columns), file_(std::make_unique<AtomicFile>(file)) {
  file_->write(header());
}

MapWriter::~MapWriter() = default;

void MapWriter::add(const MapCloud& part) {
  const std::size_t count = part.points.size();
  if (part.normals.size() != (columns_.normals ? count : 0) ||
      part.intensities.size() != (columns_.intensity ? count : 0)) {
    throw std::invalid_argument("MapWriter: a column that the map has is as long as the points, another one empty");
  }
  std::string rows;
  for (std::size_t i = 0; i < count; ++i) {
    rows.clear();
    for (Eigen::Index k = 0; k < 3; ++k) detail::append_bytes(rows, part.points[i][k]);
    for (Eigen::Index k = 0; columns_.normals && k < 3; ++k) detail::append_bytes(rows, part.normals[i][k]);
    if (columns_.intensity) detail::append_bytes(rows, part.intensities[i]);
    file_->write(rows);
  }
  count_ += count;
}

void MapWriter::finish() {
  file_->overwrite(0, header());
  file_->commit();
}

// Always of the same length: a comment takes up what the count leaves.
std::string MapWriter::header() const {
  const std::string count = std::to_string(count_);
  if (ply_) {
    const std::string padding(30 - count.size(), ' ');
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment Rilo map{}\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}{}end_header\n",
        padding, count, columns_.normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        columns_.intensity ? "property float intensity\n" : "");
  }
  const std::string padding(60 - 2 * count.size(), ' ');
  const std::size_t more = (columns_.normals ? 3 : 0) + (columns_.intensity ? 1 : 0);
  const auto repeated = [more](const char* word) {
    std::string text;
    for (std::size_t i = 0; i < 3 + more; ++i) text += word;
    return text;
  };
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n# Rilo map{}\nVERSION 0.7\nFIELDS x y z{}{}\nSIZE{}\n"
      "TYPE{}\nCOUNT{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      padding, columns_.normals ? " normal_x normal_y normal_z" : "", columns_.intensity ? " intensity" : "",
      repeated(" 4"), repeated(" F"), repeated(" 1"), count, count);
}

void write_map(const std::filesystem::path& file, const MapCloud& map) {
  MapWriter writer(file, {!map.normals.empty(), !map.intensities.empty()});
  writer.add(map);
  writer.finish();
}

}  // namespace rilo
