// One frame of an Ouster after the other.
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "io/packets/ouster.hpp"
#include "io/packets/packet_order.hpp"
#include "io/raw_bytes.hpp"

namespace rilo::detail {
namespace {

struct Pixel {
  double range_m = 0;
  float reflectivity = 0;
};

Pixel pixel_at(std::string_view bytes, const OusterLayout& layout, std::size_t at) {
  constexpr double kMillimetres = 1e-3;
  const std::uint32_t range = load_bytes<std::uint32_t>(bytes, at) & layout.range_mask;
  const std::size_t place = at + layout.reflectivity_at;
  const unsigned reflectivity =
      layout.wide_reflectivity ? load_bytes<std::uint16_t>(bytes, place) : load_bytes<std::uint8_t>(bytes, place);
  return {range * layout.range_unit_mm * kMillimetres, static_cast<float>(reflectivity)};
}

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

class OusterDecoder final : public PacketDecoder {
 public:
  explicit OusterDecoder(OusterMetadata metadata)
      : metadata_(std::move(metadata)),
        layout_(ouster_layout(metadata_.profile)),
        packet_bytes_(ouster_packet_bytes(metadata_)),
        clock_(0),
        order_(0) {}

  std::string description() const override {
    const std::string product = metadata_.product.empty() ? "" : " " + metadata_.product;
    const bool dual = metadata_.profile == OusterProfile::kRng19Dual;
    return "Ouster" + product + ", " + to_string(metadata_.profile) + (dual ? ", the first of two returns" : "");
  }
  std::size_t clock_resets() const override { return clock_.resets(); }
  std::size_t dropped_packets() const override { return order_.dropped(); }
  bool accepts(std::string_view payload) const override {
    return payload.size() == packet_bytes_ && !contradict(identity_of(payload).serial, metadata_.identity.serial);
  }

  bool is_of_another(std::string_view payload) const override {
    return payload.size() == packet_bytes_ && !accepts(payload);
  }

  void take(std::string_view payload, std::int64_t received_ns, std::deque<DecodedSweep>& done) override {
    const std::size_t column_bytes = layout_.column_bytes(metadata_.pixels());
    if (const auto start = identity_of(payload).start; contradict(start, metadata_.identity.start))
      other_start_ = start;
    std::optional<PacketOrder::Arrival> arrival;  // by the first valid column: others have no time
    for (std::size_t i = 0; i < metadata_.columns_per_packet; ++i) {
      const std::string_view column = payload.substr(layout_.packet_header + i * column_bytes, column_bytes);
      const bool legacy = metadata_.profile == OusterProfile::kLegacy;
      const auto frame = legacy ? load_bytes<std::uint16_t>(column, 10) : load_bytes<std::uint16_t>(payload, 2);
      const bool valid = legacy ? load_bytes<std::uint32_t>(column, column_bytes - 4) == 0xFFFFFFFF
                                : (load_bytes<std::uint16_t>(column, 10) & 1) != 0;
      if (!valid) continue;
      const std::int64_t sensor_ns =
          static_cast<std::int64_t>(load_bytes<std::uint64_t>(column, 0) & (~std::uint64_t{0} >> 1));
      if (!arrival) arrival = order_.arrival(sensor_ns, load_bytes<std::uint16_t>(column, 8));
      if (*arrival == PacketOrder::Arrival::kDropped) return;
      if (*arrival == PacketOrder::Arrival::kNext) begin_frame(frame, done);
      add_column(column, clock_.stamp_ns(sensor_ns, received_ns));
    }
  }

  void finish(std::deque<DecodedSweep>& done) override { end_frame(done); }

  std::vector<std::string> warnings() const override {
    if (other_start_ == 0) return {};
    return {"the sensor was set up again between its metadata and the packets (initialization_id " +
            std::to_string(metadata_.identity.start) + " and " + std::to_string(other_start_) +
            "): where its mode was changed, the points are wrong"};
  }

 private:
  // Two that are known and differ.
  static bool contradict(std::uint64_t a, std::uint64_t b) { return a != 0 && b != 0 && a != b; }
  OusterIdentity identity_of(std::string_view payload) const {
    return metadata_.profile == OusterProfile::kLegacy ? OusterIdentity{} : ouster_identity(payload);
  }

  void begin_frame(std::uint16_t frame, std::deque<DecodedSweep>& done) {
    // Nothing has more columns than a frame: a counter that does not advance must not gather the whole recording.
    if (frame_ && *frame_ == frame && columns_ < metadata_.columns_per_frame) return;
    end_frame(done);
    order_.begin_sweep();
    frame_ = frame;
  }

  void end_frame(std::deque<DecodedSweep>& done) {
    // Some columns may be lost on the way.
    if (!sweep_.empty()) done.push_back({sweep_.take(), columns_ * 10 >= metadata_.columns_sent * 9});
    columns_ = 0;
  }

  void add_column(std::string_view column, std::int64_t time_ns) {
    const std::size_t id = load_bytes<std::uint16_t>(column, 8);
    if (id >= metadata_.columns_per_frame) return;
    ++columns_;
    const double turned =
        2 * std::numbers::pi * (1 - static_cast<double>(id) / static_cast<double>(metadata_.columns_per_frame));
    for (std::size_t k = 0; k < metadata_.pixels(); ++k) {
      const Pixel pixel = pixel_at(column, layout_, layout_.column_header + k * layout_.pixel);
      if (pixel.range_m <= metadata_.beam_origin_m) continue;  // 0: no return
      // The uppermost beam is the first; rings count from below.
      sweep_.add(point_of(pixel.range_m, turned, k), pixel.reflectivity,
                 static_cast<std::uint16_t>(metadata_.pixels() - 1 - k), time_ns);
    }
  }

  // The range is from the axis to the beam's origin and on to the target.
  Eigen::Vector3f point_of(double range_m, double turned, std::size_t beam) const {
    const double origin = metadata_.beam_origin_m;
    const double azimuth = turned - metadata_.azimuths_rad[beam];
    const double across = (range_m - origin) * std::cos(metadata_.elevations_rad[beam]);
    const Eigen::Vector4d point(across * std::cos(azimuth) + origin * std::cos(turned),
                                across * std::sin(azimuth) + origin * std::sin(turned),
                                (range_m - origin) * std::sin(metadata_.elevations_rad[beam]), 1);
    return (metadata_.T_sensor_lidar * point).head<3>().cast<float>();
  }

  OusterMetadata metadata_;
  OusterLayout layout_;
  std::size_t packet_bytes_;
  PacketClock clock_;
  PacketOrder order_;
  GrowingSweep sweep_;
  std::optional<std::uint16_t> frame_;
  std::size_t columns_ = 0;        // of the frame so far
  std::uint32_t other_start_ = 0;  // of a packet, when it is not that of the metadata
};

}  // namespace

OusterIdentity ouster_identity(std::string_view packet) {
  constexpr std::size_t kHeader = 12;
  if (packet.size() < kHeader) return {};
  return {number_at(packet, 7, 5), static_cast<std::uint32_t>(number_at(packet, 4, 3))};
}

std::unique_ptr<PacketDecoder> ouster_decoder(OusterMetadata metadata) {
  return std::make_unique<OusterDecoder>(std::move(metadata));
}

}  // namespace rilo::detail
