// One file of points: .bin, .pcd, .ply.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace rilo {

enum class ScalarType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
};
std::size_t size_of(ScalarType type);
bool is_floating(ScalarType type);
/// int8 … uint64, float32, float64.
std::string_view to_string(ScalarType type);

/// A time field as stored in the file: integers in `integers`, floating point in `floats`; unit and reference are
/// PointTimeDecoder's business.
struct RawTimes {
  std::string field;
  ScalarType type = ScalarType::kFloat32;
  std::vector<double> floats;
  std::vector<std::int64_t> integers;

  std::size_t size() const { return is_floating(type) ? floats.size() : integers.size(); }
};

/// The columns of a cloud file that we use; the optional ones are empty or as long as `points`.
struct RawCloud {
  std::vector<Eigen::Vector3f> points;  ///< m, sensor frame; NaN allowed
  std::vector<float> intensities;
  std::vector<std::uint16_t> rings;
  std::optional<RawTimes> times;
};

/// Records of float32. `fields`: see SourceOptions::bin_fields.
/// @throws IoError when the size is not a multiple of the record; std::invalid_argument when `fields` makes no sense.
RawCloud read_bin(const std::filesystem::path& file, const std::string& fields = "x,y,z,intensity");

/// PCD: ascii, binary, binary_compressed. `time_field`: see SourceOptions::time_field.
RawCloud read_pcd(const std::filesystem::path& file, const std::string& time_field = "");

/// PLY: ascii, binary little and big endian.
RawCloud read_ply(const std::filesystem::path& file, const std::string& time_field = "");

}  // namespace rilo
