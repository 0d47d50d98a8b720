// The binary messages between page and program, version 1. Layout: frames.md. Everything is little endian.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "sweep_points.hpp"
#include "view/budgeted_map.hpp"
#include "view/view_sweep.hpp"

namespace rilo::view {

constexpr std::uint8_t kProtocolVersion = 1;
constexpr std::size_t kHeaderBytes = 8;
constexpr std::size_t kRecordBytes = 216;
constexpr std::size_t kRequestBytes = 8;

enum class FrameType : std::uint8_t { kInfo = 1, kRecords = 2, kMap = 3, kSweep = 4, kProgress = 5 };

using Bytes = std::vector<std::uint8_t>;
using Frame = std::shared_ptr<const Bytes>;  // shared by all connections that it is sent on

struct Progress {
  std::uint32_t sweeps = 0;
  std::uint32_t total = 0;  // 0: unknown
  bool finished = false;
  std::uint32_t dropped = 0;

  friend bool operator==(const Progress&, const Progress&) = default;
};

/// JSON text.
Frame info_frame(std::string_view json);

/// Appends the record of one sweep to `records`.
void append_record(const ViewSweep& sweep, Bytes& records);

/// `records`: whole records, the first is that of sweep number `first`.
Frame records_frame(std::uint32_t first, std::span<const std::uint8_t> records);

/// Points of one chunk of the map; positions are cut to what 16 bits hold around the middle of the chunk. `begins`: the
/// page forgets the points that it has.
Frame map_frame(std::span<const MapPoint> points, double voxel_m, bool begins);

/// Points of a sweep in the sensor frame, with what colours them.
Frame sweep_frame(std::uint32_t number, const SweepPoints& sweep);

Frame progress_frame(const Progress& progress);

/// What a page may ask for.
struct Request {
  enum class Kind : std::uint8_t { kSweep = 1, kFollow = 2 };
  Kind kind = Kind::kSweep;
  std::uint32_t value = 0;  ///< number of the sweep; whether to follow
};

/// Nothing when the message is none of these.
std::optional<Request> parse_request(std::span<const std::uint8_t> message);

}  // namespace rilo::view
