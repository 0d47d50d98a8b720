// Velodyne's packets of 1206 bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/packets/packet_decoder.hpp"

namespace rilo::detail {

struct VelodyneLaser {
  double elevation_rad = 0;
  double azimuth_rad = 0;          ///< added to the block's; clockwise seen from above
  double vertical_offset_m = 0;    ///< of the laser's origin
  double horizontal_offset_m = 0;  ///< of the laser's origin
  double distance_offset_m = 0;    ///< added to every distance
  double fires_after_us = 0;       ///< since the firing began
  std::uint16_t ring = 0;          ///< 0: the lowest
};

struct VelodyneModel {
  std::string name;
  std::optional<std::uint8_t> product;  ///< the last byte of its packets; HDL-64E have others there
  double unit_m = 0.002;
  double firing_us = 0;             ///< from one firing to the next
  std::size_t firings_a_block = 1;  ///< 2 for sensors of 16 lasers
  bool two_banks = false;           ///< HDL-64E: blocks come in pairs, upper and lower
  std::vector<VelodyneLaser> lasers;
};

constexpr std::size_t kVelodynePacket = 1206;

/// The model that a packet says it is from; HDL-64E, which does not say, by its two banks.
/// @throws IoError for models that we do not know, and for HDL-64E when `calibration` is empty.
VelodyneModel velodyne_model(std::string_view packet, const std::filesystem::path& file,
                             const std::filesystem::path& calibration);

/// Sets the angles and offsets of the lasers from a calibration file of the ROS driver velodyne_pointcloud (YAML).
/// @throws IoError.
void read_velodyne_calibration(const std::filesystem::path& calibration, VelodyneModel& model);

/// Numbers the lasers by elevation.
void set_rings(VelodyneModel& model);

/// A sweep is a revolution from straight behind to straight behind.
std::unique_ptr<PacketDecoder> velodyne_decoder(VelodyneModel model);

}  // namespace rilo::detail
