#include "rilo/io/map_writer.hpp"

#include <bit>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

static_assert(std::endian::native == std::endian::little, "maps and sweeps are written as they lie in memory");

bool is_ply(const std::filesystem::path& file) {
  const std::string extension = detail::lower_case(file.extension().string());
  if (extension != ".ply" && extension != ".pcd") {
    throw IoError({file, "", "the extension " + detail::in_quotes(file.extension().string()), ".ply or .pcd",
                   "Give the map a name that ends so"});
  }
  return extension == ".ply";
}

}  // namespace

MapWriter::MapWriter(const std::filesystem::path& file, bool with_intensity)
    : ply_(is_ply(file)), with_intensity_(with_intensity), file_(file) {
  file_.write(header());
}

void MapWriter::add(std::span<const Eigen::Vector3f> points, std::span<const float> intensities) {
  if (intensities.size() != (with_intensity_ ? points.size() : 0)) {
    throw std::invalid_argument("MapWriter: as many intensities as points, or none when the map has no intensity");
  }
  std::string row((with_intensity_ ? 4 : 3) * sizeof(float), '\0');
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(row.data(), points[i].data(), 3 * sizeof(float));
    if (with_intensity_) std::memcpy(row.data() + 3 * sizeof(float), &intensities[i], sizeof(float));
    file_.write(row);
  }
  count_ += points.size();
}

void MapWriter::finish() {
  file_.overwrite(0, header());
  file_.commit();
}

// Always of the same length: a comment takes up what the count leaves.
std::string MapWriter::header() const {
  const std::string count = std::to_string(count_);
  if (ply_) {
    const std::string padding(30 - count.size(), ' ');
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment Rilo map{}\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}end_header\n",
        padding, count, with_intensity_ ? "property float intensity\n" : "");
  }
  const std::string padding(60 - 2 * count.size(), ' ');
  const bool four = with_intensity_;
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\n# Rilo map{}\nVERSION 0.7\nFIELDS x y z{}\nSIZE 4 4 4{}\n"
      "TYPE F F F{}\nCOUNT 1 1 1{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      padding, four ? " intensity" : "", four ? " 4" : "", four ? " F" : "", four ? " 1" : "", count, count);
}

void write_map(const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points,
               const std::vector<float>& intensities) {
  MapWriter writer(file, !intensities.empty());
  writer.add(points, intensities);
  writer.finish();
}

}  // namespace rilo
