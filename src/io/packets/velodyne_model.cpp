// The sensors of Velodyne, from their manuals.
#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "geometry/degrees.hpp"
#include "io/file_bytes.hpp"
#include "io/packets/velodyne.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

constexpr std::array<double, 16> kVlp16{-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
constexpr std::array<double, 16> kVlp16OffsetMm{11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
constexpr std::array<double, 16> kPuckHiRes{-10,    0.667, -8.667, 2,     -7.333, 3.333, -6,     4.667,
                                            -4.667, 6,     -3.333, 7.333, -2,     8.667, -0.667, 10};
constexpr std::array<double, 32> kHdl32{-30.67, -9.33, -29.33, -8, -28, -6.67, -26.67, -5.33, -25.33, -4, -24, -2.67,
                                        -22.67, -1.33, -21.33, 0,  -20, 1.33,  -18.67, 2.67,  -17.33, 4,  -16, 5.33,
                                        -14.67, 6.67,  -13.33, 8,  -12, 9.33,  -10.67, 10.67};
constexpr std::array<double, 32> kVlp32C{-25,    -1,    -1.667, -15.639, -11.31, 0,     -0.667, -8.843,
                                         -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4,
                                         -4.667, 1.667, 1,      -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                         -3,     7,     4.667,  -2.333,  -2,     15,    10.333, -1.333};
constexpr std::array<double, 32> kVlp32CAzimuth{1.4,  -4.2, 1.4,  -1.4, 1.4,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,
                                                -1.4, 4.2,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,  -4.2, 4.2,  -1.4,
                                                1.4,  -1.4, 1.4,  -1.4, 1.4,  -4.2, 4.2,  -1.4, 1.4,  -1.4};

VelodyneModel make(std::string name, double unit_m, double firing_us, double laser_us, std::size_t at_once,
                   std::span<const double> elevations_deg) {
  VelodyneModel model;
  model.name = std::move(name);
  model.unit_m = unit_m;
  model.firing_us = firing_us;
  model.firings_a_block = elevations_deg.size() == 16 ? 2 : 1;
  for (std::size_t i = 0; i < elevations_deg.size(); ++i) {
    VelodyneLaser laser;
    laser.elevation_rad = elevations_deg[i] * kRadPerDeg;
    const std::size_t group = i / at_once;  // lasers of a group fire together
    laser.fires_after_us = static_cast<double>(group) * laser_us;
    model.lasers.push_back(laser);
  }
  set_rings(model);
  return model;
}

VelodyneModel hdl64(const std::filesystem::path& file, const std::filesystem::path& calibration) {
  if (calibration.empty()) {
    throw IoError({file, "", "packets of a Velodyne HDL-64E, every one of which has angles of its own",
                   "its calibration", "Give the YAML file of the ROS driver velodyne_pointcloud with --sensor-file"});
  }
  VelodyneModel model = make("HDL-64E", 0.002, 48, 1.5, 1, std::array<double, 64>{});
  for (std::size_t i = 0; i < model.lasers.size(); ++i) {
    model.lasers[i].fires_after_us = static_cast<double>(i % 32) * 1.5;  // both banks at once
  }
  model.two_banks = true;
  read_velodyne_calibration(calibration, model);
  return model;
}

bool has_bank(std::string_view packet, std::string_view flag) {
  constexpr std::size_t kBlock = 100;
  for (std::size_t block = 0; block < 12; ++block) {
    if (packet.substr(block * kBlock, 2) == flag) return true;
  }
  return false;
}

IoError not_decoded(const std::filesystem::path& file, const std::string& found) {
  return IoError({file, "", found,
                  "an HDL-32E (0x21), VLP-16 (0x22), Puck Hi-Res (0x24), VLP-32C (0x28) or HDL-64E (two banks)",
                  "Decode the packets with Velodyne's driver and record the point clouds (PointCloud2)"});
}

double number_of(const YAML::Node& laser, const char* key) {
  const YAML::Node value = laser[key];
  return value ? value.as<double>() : 0.0;
}

}  // namespace

void set_rings(VelodyneModel& model) {
  std::vector<std::size_t> order(model.lasers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return model.lasers[a].elevation_rad < model.lasers[b].elevation_rad;
  });
  for (std::size_t i = 0; i < order.size(); ++i) model.lasers[order[i]].ring = static_cast<std::uint16_t>(i);
}

VelodyneModel velodyne_model(std::string_view packet, const std::filesystem::path& file,
                             const std::filesystem::path& calibration) {
  // Before the HDL-64E, whose two banks it has as well, and whose last byte may be any.
  if (has_bank(packet, "\xFF\xCC") || has_bank(packet, "\xFF\xBB")) {
    throw not_decoded(file, "packets of a Velodyne VLS-128 (Alpha Prime), which has four banks");
  }
  if (has_bank(packet, "\xFF\xDD")) return hdl64(file, calibration);
  VelodyneModel model;
  const auto product = static_cast<unsigned char>(packet[kVelodynePacket - 1]);
  switch (product) {
    case 0x21:
      model = make("HDL-32E", 0.002, 46.08, 1.152, 1, kHdl32);
      break;
    case 0x22:
      model = make("VLP-16", 0.002, 55.296, 2.304, 1, kVlp16);
      for (std::size_t i = 0; i < 16; ++i) model.lasers[i].vertical_offset_m = kVlp16OffsetMm[i] * 1e-3;
      break;
    case 0x24:
      model = make("Puck Hi-Res", 0.002, 55.296, 2.304, 1, kPuckHiRes);
      break;
    case 0x28:
      model = make("VLP-32C", 0.004, 55.296, 2.304, 2, kVlp32C);
      for (std::size_t i = 0; i < 32; ++i) model.lasers[i].azimuth_rad = kVlp32CAzimuth[i] * kRadPerDeg;
      break;
    default:
      throw not_decoded(file, fmt::format("Velodyne's product number 0x{:02x}", product));
  }
  model.product = product;
  if (!calibration.empty()) read_velodyne_calibration(calibration, model);
  return model;
}

void read_velodyne_calibration(const std::filesystem::path& calibration, VelodyneModel& model) {
  const auto reject = [&](const std::string& found) {
    throw IoError({calibration, "", found,
                   "a calibration of " + std::to_string(model.lasers.size()) + " lasers as velodyne_pointcloud has it",
                   "Make it from the sensor's db.xml with gen_calibration.py of velodyne_pointcloud"});
  };
  const FileBytes bytes = read_file(calibration);
  try {
    const YAML::Node root = YAML::Load(std::string(bytes.view()));
    const YAML::Node lasers = root["lasers"];
    if (!lasers || !lasers.IsSequence() || lasers.size() != model.lasers.size()) {
      reject(lasers && lasers.IsSequence() ? std::to_string(lasers.size()) + " lasers" : "no list of lasers");
    }
    std::set<std::size_t> ids;
    if (root["distance_resolution"]) model.unit_m = root["distance_resolution"].as<double>();
    for (const YAML::Node& entry : lasers) {
      const auto id = entry["laser_id"].as<std::size_t>();
      if (id >= model.lasers.size()) reject("laser_id " + std::to_string(id));
      if (!ids.insert(id).second) reject("laser_id " + std::to_string(id) + " twice");
      VelodyneLaser& laser = model.lasers[id];
      laser.elevation_rad = entry["vert_correction"].as<double>();
      laser.azimuth_rad = -number_of(entry, "rot_correction");
      laser.vertical_offset_m = number_of(entry, "vert_offset_correction");
      laser.horizontal_offset_m = number_of(entry, "horiz_offset_correction");
      laser.distance_offset_m = number_of(entry, "dist_correction");
    }
  } catch (const YAML::Exception& error) {
    reject("text that cannot be used: " + std::string(error.what()));
  }
  set_rings(model);
}

}  // namespace rilo::detail
