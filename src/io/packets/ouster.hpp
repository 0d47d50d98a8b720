// Ouster's LiDAR packets and the metadata that they need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "io/packets/packet_decoder.hpp"

namespace rilo::detail {

enum class OusterProfile : std::uint8_t { kLegacy, kRng15, kRng19, kRng19Dual };

/// Of a sensor and of one of its starts; 0: unknown.
struct OusterIdentity {
  std::uint64_t serial = 0;
  std::uint32_t start = 0;  ///< initialization_id: another one each time the sensor is set up

  friend bool operator==(const OusterIdentity&, const OusterIdentity&) = default;
};
/// Of a packet, of any profile but LEGACY, which has none.
OusterIdentity ouster_identity(std::string_view packet);

struct OusterMetadata {
  std::string product;  ///< "OS-1-128", as far as known
  OusterIdentity identity;
  OusterProfile profile = OusterProfile::kLegacy;
  std::size_t columns_per_frame = 1024;
  std::size_t columns_per_packet = 16;
  std::size_t columns_sent = 1024;  ///< of a frame: the window may be smaller than a revolution
  std::vector<double> elevations_rad;
  std::vector<double> azimuths_rad;
  double beam_origin_m = 0;                                      ///< from the axis of rotation
  Eigen::Matrix4d T_sensor_lidar = Eigen::Matrix4d::Identity();  ///< m

  std::size_t pixels() const { return elevations_rad.size(); }
};

/// The JSON that the sensor gives, of all its versions.
/// @throws IoError naming the key.
OusterMetadata read_ouster_metadata(const std::filesystem::path& file);
/// The same from its text; `file` and `part` ("topic /ouster/metadata") are for messages.
OusterMetadata parse_ouster_metadata(std::string_view text, const std::filesystem::path& file,
                                     const std::string& part = {});

/// Where the bytes of a packet lie, and what a pixel's mean.
struct OusterLayout {
  std::size_t packet_header = 0;
  std::size_t column_header = 0;
  std::size_t column_footer = 0;
  std::size_t pixel = 0;
  std::size_t packet_footer = 0;
  std::uint32_t range_mask = 0;  ///< of the first 32 bits of a pixel
  std::uint32_t range_unit_mm = 1;
  std::size_t reflectivity_at = 0;  ///< in a pixel
  bool wide_reflectivity = false;   ///< 16 bits, else 8

  std::size_t column_bytes(std::size_t pixels) const { return column_header + pixels * pixel + column_footer; }
};
OusterLayout ouster_layout(OusterProfile profile);
/// As the metadata have it: "RNG15_RFL8_NIR8".
std::string to_string(OusterProfile profile);
std::size_t ouster_packet_bytes(const OusterMetadata& metadata);

/// A sweep is a frame of the sensor.
std::unique_ptr<PacketDecoder> ouster_decoder(OusterMetadata metadata);

}  // namespace rilo::detail
