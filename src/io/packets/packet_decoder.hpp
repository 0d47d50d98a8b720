// From the packets of a sensor to its sweeps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/cloud/sweep.hpp"

namespace rilo::detail {

/// The sensor's clock on the recorder's time scale. A clock that already shows the recorder's time (GPS, PTP) is taken
/// as it is; any other is set by the first packet and keeps its own rate from there.
class PacketClock {
 public:
  /// `wrap_ns`: period after which the sensor's clock wraps; 0: never.
  explicit PacketClock(std::int64_t wrap_ns) : wrap_ns_(wrap_ns) {}

  std::int64_t stamp_ns(std::int64_t sensor_ns, std::int64_t received_ns);

  /// Times that the sensor's clock was set: it went apart from the recorder's by more than a second.
  std::size_t resets() const { return resets_; }

 private:
  std::int64_t nearest(std::int64_t time_ns, std::int64_t to_ns) const;

  std::int64_t wrap_ns_;
  bool set_ = false;
  std::int64_t offset_ns_ = 0;
  std::size_t resets_ = 0;
};

/// A sweep that grows. Times are absolute until it is done.
class GrowingSweep {
 public:
  void add(const Eigen::Vector3f& point, float intensity, std::uint16_t ring, std::int64_t time_ns);
  bool empty() const { return sweep_.points.empty(); }
  std::size_t size() const { return sweep_.points.size(); }
  /// The sweep, stamped at its earliest point; begins a new one.
  Sweep take();

 private:
  Sweep sweep_;
  std::vector<std::int64_t> times_ns_;
};

struct DecodedSweep {
  Sweep sweep;
  bool whole = true;  ///< false for the first and the last, when they lack a part
};

class PacketDecoder {
 public:
  virtual ~PacketDecoder() = default;

  /// For people: "Velodyne VLP-16, strongest returns".
  virtual std::string description() const = 0;

  /// Whether a payload may be one of the sensor's LiDAR packets.
  virtual bool accepts(std::string_view payload) const = 0;
  /// Whether it is a LiDAR packet of the same kind, but says that it is another sensor's.
  virtual bool is_of_another(std::string_view payload) const = 0;
  /// Takes a packet that it accepts; sweeps that are done with it are appended.
  virtual void take(std::string_view payload, std::int64_t received_ns, std::deque<DecodedSweep>& done) = 0;
  /// The last sweep.
  virtual void finish(std::deque<DecodedSweep>& done) = 0;
  virtual std::size_t clock_resets() const = 0;
  /// Packets that came twice or too late for their sweep.
  virtual std::size_t dropped_packets() const = 0;
  /// Sentences for the user.
  virtual std::vector<std::string> warnings() const { return {}; }

 protected:
  PacketDecoder() = default;
  PacketDecoder(const PacketDecoder&) = default;
  PacketDecoder& operator=(const PacketDecoder&) = default;
};

}  // namespace rilo::detail
