// Captures of sensors, made byte by byte.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "io/ros/ros_bytes.hpp"

namespace rilo::test {

/// A pcap file with nanoseconds.
class Capture {
 public:
  explicit Capture(std::uint32_t link = 1) {
    bytes_.put(std::uint32_t{0xA1B23C4D}).put(std::uint16_t{2}).put(std::uint16_t{4}).put(std::int32_t{0});
    bytes_.put(std::uint32_t{0}).put(std::uint32_t{65535}).put(link);
  }

  /// A frame as it is.
  Capture& frame(std::int64_t stamp_ns, std::string_view frame) {
    bytes_.put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    bytes_.put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    bytes_.put(static_cast<std::uint32_t>(frame.size())).put(static_cast<std::uint32_t>(frame.size()));
    bytes_.raw(frame);
    return *this;
  }

  /// The last byte of the address that datagrams come from.
  Capture& from(char sender) {
    sender_ = sender;
    return *this;
  }

  /// A datagram in one Ethernet frame, or in fragments of at most `mtu` bytes.
  Capture& udp(std::int64_t stamp_ns, std::uint16_t port, std::string_view payload, std::size_t mtu = 65000) {
    std::string datagram = big(2000) + big(port) + big(static_cast<std::uint16_t>(payload.size() + 8)) + big(0);
    datagram += payload;
    ++identification_;
    for (std::size_t at = 0; at < datagram.size(); at += mtu) {
      const std::string_view part = std::string_view(datagram).substr(at, mtu);
      frame(stamp_ns, ethernet(ipv4(part, at, at + part.size() < datagram.size())));
    }
    return *this;
  }

  static std::string big(std::uint16_t value) {
    return {static_cast<char>(value >> 8), static_cast<char>(value & 255)};
  }
  std::string ipv4(std::string_view part, std::size_t offset, bool more) const {
    std::string header("\x45\0", 2);
    header += big(static_cast<std::uint16_t>(20 + part.size())) + big(identification_);
    header += big(static_cast<std::uint16_t>(offset / 8 + (more ? 0x2000 : 0)));
    header += std::string("\x40\x11\0\0\x0A\0\0", 7) + sender_ + std::string("\x0A\0\0\2", 4);
    return header + std::string(part);
  }
  static std::string ethernet(const std::string& packet, const std::string& vlan = "") {
    return std::string(12, '\x11') + vlan + std::string("\x08\0", 2) + packet;
  }

  const std::string& text() const { return bytes_.text; }

 private:
  Bytes bytes_;
  std::uint16_t identification_ = 0;
  char sender_ = 1;
};

/// A packet of a Velodyne with 12 blocks from `azimuth` (0.01°) on in steps of `step`, all distances the same.
inline std::string velodyne_packet(int azimuth, int step, std::uint32_t hour_us, std::uint8_t product,
                                   std::uint16_t distance = 5000, std::uint8_t mode = 0x37) {
  Bytes bytes;
  for (int block = 0; block < 12; ++block) {
    const int of_block = mode == 0x39 ? block / 2 : block;
    bytes.put(std::uint16_t{0xEEFF}).put(static_cast<std::uint16_t>((azimuth + of_block * step) % 36000));
    for (int k = 0; k < 32; ++k) {
      const int shift = mode == 0x39 && block % 2 == 1 ? 1000 : 0;  // the other return is nearer
      bytes.put(static_cast<std::uint16_t>(distance - shift)).put(static_cast<std::uint8_t>(k));
    }
  }
  return bytes.put(hour_us).put(mode).put(product).text;
}

// An Ouster of four beams and 1024 columns at 10 Hz.
struct OusterShape {
  std::string profile;
  std::size_t pixel;
  bool legacy;
};

// Zeros: not known.
struct OusterIds {
  std::uint64_t serial = 0;
  std::uint32_t start = 0;
};

inline std::string ouster_metadata(const OusterShape& shape, const OusterIds& ids = {}) {
  return R"({"prod_sn": ")" + std::to_string(ids.serial) + R"(", "initialization_id": )" + std::to_string(ids.start) +
         R"(, "lidar_mode": "1024x10", "prod_line": "OS-1-4", "beam_altitude_angles": [10, 0, -10, -20],
            "beam_azimuth_angles": [0, 1, 0, -1], "lidar_origin_to_beam_origin_mm": 15.0,
            "data_format": {"columns_per_frame": 1024, "columns_per_packet": 16, "pixels_per_column": 4,
                            "udp_profile_lidar": ")" +
         shape.profile + "\"}}";
}

inline std::string ouster_pixel(const OusterShape& shape, std::uint32_t range_mm, std::uint8_t reflectivity) {
  std::string pixel(shape.pixel, '\0');
  const std::uint32_t word = shape.pixel == 4 ? range_mm / 8 : range_mm;
  std::memcpy(pixel.data(), &word, 4);
  pixel[shape.pixel == 4 ? 2 : shape.pixel == 16 ? 3 : 4] = static_cast<char>(reflectivity);
  return pixel;
}

inline std::string ouster_packet(const OusterShape& shape, std::uint16_t frame, std::size_t first_column,
                                 std::uint64_t ns, const OusterIds& ids = {}) {
  Bytes bytes;
  if (!shape.legacy) {
    bytes.put(std::uint16_t{1}).put(frame).put(ids.serial << 24U | ids.start);
    bytes.raw(std::string(20, '\0'));
  }
  for (std::size_t i = 0; i < 16; ++i) {
    const auto column = static_cast<std::uint16_t>(first_column + i);
    bytes.put(ns + i * 97'656).put(column);
    if (shape.legacy) {
      bytes.put(frame).put(std::uint32_t{0});
    } else {
      bytes.put(std::uint16_t{1});
    }
    for (std::uint8_t k = 0; k < 4; ++k)
      bytes.raw(ouster_pixel(shape, k == 3 ? 0 : 8000, static_cast<std::uint8_t>(k + 7)));
    if (shape.legacy) bytes.put(std::uint32_t{0xFFFFFFFF});
  }
  if (!shape.legacy) bytes.raw(std::string(32, '\0'));
  return bytes.text;
}

inline const std::vector<OusterShape> kOusterShapes{{"LEGACY", 12, true},
                                                    {"RNG15_RFL8_NIR8", 4, false},
                                                    {"RNG19_RFL8_SIG16_NIR16", 12, false},
                                                    {"RNG19_RFL8_SIG16_NIR16_DUAL", 16, false}};

inline constexpr std::int64_t kCaptureBegin = 1'700'000'123'000'000'000;

// `turns` of a sensor of 10 Hz: packets of 12 blocks of 1°, 30 a turn, from `azimuth` on.
inline Capture velodyne_drive(std::uint8_t product, double turns, int azimuth = 9000, std::uint32_t hour_us = 100) {
  Capture capture;
  const auto packets = static_cast<int>(turns * 30);
  for (int i = 0; i < packets; ++i) {
    const std::uint32_t us = (hour_us + static_cast<std::uint32_t>(i) * 3333U) % 3'600'000'000U;
    capture.udp(kCaptureBegin + i * 3'333'000LL, 2368, velodyne_packet((azimuth + i * 1200) % 36000, 100, us, product));
    capture.udp(kCaptureBegin + i * 3'333'000LL, 8308, std::string(512, 'g'));  // its GPS
  }
  return capture;
}

// 64 packets a turn, with packets of the IMU in between.
inline Capture ouster_drive(const OusterShape& shape, std::size_t packets, std::size_t mtu = 65000,
                            const OusterIds& ids = {}) {
  Capture capture;
  for (std::size_t i = 0; i < packets; ++i) {
    const std::uint64_t ns = 5'000'000 + i * 1'562'500;
    capture.udp(kCaptureBegin + static_cast<std::int64_t>(ns), 7502,
                ouster_packet(shape, static_cast<std::uint16_t>(65535 + i / 64), i % 64 * 16, ns, ids), mtu);
    capture.udp(kCaptureBegin + static_cast<std::int64_t>(ns), 7503, std::string(48, 'i'));
  }
  return capture;
}

inline double azimuth_deg(const Eigen::Vector3f& point) {
  return std::atan2(static_cast<double>(point.y()), static_cast<double>(point.x())) * 180 / std::numbers::pi;
}

}  // namespace rilo::test
