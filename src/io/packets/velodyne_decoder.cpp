// One revolution of a Velodyne after the other.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "io/packets/packet_order.hpp"
#include "io/packets/velodyne.hpp"
#include "io/raw_bytes.hpp"

namespace rilo::detail {
namespace {

constexpr std::size_t kBlocks = 12;
constexpr std::size_t kBlockBytes = 100;
constexpr std::size_t kLasersABlock = 32;
constexpr int kTurn = 36000;         // hundredths of a degree
constexpr int kMostAStep = 300;      // 3°, from block to block, or back where the angle is noisy
constexpr double kRateMemory = 100;  // blocks
constexpr unsigned char kDual = 0x39;

class VelodyneDecoder final : public PacketDecoder {
 public:
  explicit VelodyneDecoder(VelodyneModel model) : model_(std::move(model)), clock_(kHourNs), order_(kHourNs) {}

  std::string description() const override {
    return "Velodyne " + model_.name + (dual_ ? ", of two returns the last" : "");
  }
  std::size_t clock_resets() const override { return clock_.resets(); }
  std::size_t dropped_packets() const override { return order_.dropped(); }

  bool accepts(std::string_view payload) const override { return is_lidar(payload) && has_product(payload); }
  bool is_of_another(std::string_view payload) const override { return is_lidar(payload) && !has_product(payload); }

  void take(std::string_view payload, std::int64_t received_ns, std::deque<DecodedSweep>& done) override {
    const std::int64_t hour_ns = std::int64_t{load_bytes<std::uint32_t>(payload, kBlocks * kBlockBytes)} * 1000;
    const auto arrival = order_.arrival(hour_ns, load_bytes<std::uint16_t>(payload, 2));
    if (arrival == PacketOrder::Arrival::kDropped) return;
    const std::int64_t stamp_ns = clock_.stamp_ns(hour_ns, received_ns);
    dual_ = !model_.two_banks && static_cast<unsigned char>(payload[kVelodynePacket - 2]) == kDual;
    const std::size_t group = dual_ || model_.two_banks ? 2 : 1;  // blocks of the same firing
    double gaps_us = 0;
    for (std::size_t block = 0; block < kBlocks; ++block) {
      // Of two returns, the first block of a pair has the last one, the second the strongest other.
      if (dual_ && block % 2 == 1) continue;
      if (!is_firing(payload, block)) continue;
      const std::string_view bytes = payload.substr(block * kBlockBytes, kBlockBytes);
      const int azimuth = azimuth_of(payload, block);
      if (block % group == 0) gaps_us += gap_before_us(payload, block, group);
      find_rate(payload, block, group);
      // To go back across the rear and over it again is no revolution.
      if (arrival == PacketOrder::Arrival::kNext) look_for_the_rear(azimuth, done);
      const std::size_t firings_before = block / group * model_.firings_a_block;
      add_block(bytes, is_lower(payload, block), azimuth, stamp_ns,
                static_cast<double>(firings_before) * model_.firing_us + gaps_us);
    }
  }

  void finish(std::deque<DecodedSweep>& done) override {
    if (!sweep_.empty()) done.push_back({sweep_.take(), false});
  }

 private:
  static constexpr std::int64_t kHourNs = 3'600'000'000'000;

  bool is_lidar(std::string_view payload) const {
    if (payload.size() != kVelodynePacket) return false;
    return is_firing(payload, 0) && (model_.two_banks || !is_lower(payload, 0));
  }
  bool has_product(std::string_view payload) const {
    return !model_.product || *model_.product == static_cast<unsigned char>(payload.back());
  }

  static bool is_lower(std::string_view payload, std::size_t block) {
    return payload.substr(block * kBlockBytes, 2) == "\xFF\xDD";
  }
  static bool is_firing(std::string_view payload, std::size_t block) {
    return payload.substr(block * kBlockBytes, 2) == "\xFF\xEE" || is_lower(payload, block);
  }
  static int azimuth_of(std::string_view payload, std::size_t block) {
    return load_bytes<std::uint16_t>(payload, block * kBlockBytes + 2) % kTurn;
  }
  static int step_between(std::string_view payload, std::size_t block, std::size_t next) {
    return (azimuth_of(payload, next) - azimuth_of(payload, block) + kTurn) % kTurn;
  }
  double block_us() const { return model_.firing_us * static_cast<double>(model_.firings_a_block); }

  // Hundredths of a degree a microsecond, from this block to the next.
  void find_rate(std::string_view payload, std::size_t block, std::size_t group) {
    if (block + group >= kBlocks) return;
    const int step = step_between(payload, block, block + group);
    if (step > kMostAStep) return;
    rate_ = step / block_us();
    rates_ = std::min(rates_ + 1, kRateMemory);
    mean_rate_ += (rate_ - mean_rate_) / rates_;
  }

  // A sensor that sends a part of the turn fills a packet from both sides of the rest. The packet has one stamp.
  double gap_before_us(std::string_view payload, std::size_t block, std::size_t group) const {
    if (block < group || !is_firing(payload, block - group) || mean_rate_ <= 0) return 0;
    const int step = step_between(payload, block - group, block);
    return step > kMostAStep && step < kTurn - kMostAStep ? step / mean_rate_ - block_us() : 0;
  }

  // A revolution ends straight behind, or where the turn goes on that is seen beyond it.
  void look_for_the_rear(int azimuth, std::deque<DecodedSweep>& done) {
    constexpr std::size_t kMostPoints = std::size_t{1} << 20;  // a motor that does not run gives no revolution
    const int since_rear = (azimuth + kTurn / 2) % kTurn;
    constexpr int kJustBehind = 200;
    if (last_since_rear_ < 0) whole_ = since_rear <= kJustBehind;
    // Sensors turn one way: to go back is to go on over the rear, but for the noise of the angle.
    const bool at_rear = since_rear < last_since_rear_ - kMostAStep;
    if (at_rear || sweep_.size() > kMostPoints) {
      if (!sweep_.empty()) done.push_back({sweep_.take(), whole_ && at_rear});
      whole_ = at_rear;
      order_.begin_sweep();
    }
    last_since_rear_ = since_rear;
  }

  void add_block(std::string_view bytes, bool lower, int azimuth, std::int64_t stamp_ns, double begins_us) {
    for (std::size_t k = 0; k < kLasersABlock; ++k) {
      const std::uint16_t distance = load_bytes<std::uint16_t>(bytes, 4 + 3 * k);
      if (distance == 0) continue;
      const std::size_t in_block = k / model_.lasers.size();  // the second firing of 16 lasers
      const std::size_t index = k % model_.lasers.size() + (model_.two_banks && lower ? kLasersABlock : 0);
      const VelodyneLaser& laser = model_.lasers[index];
      const double block_us = static_cast<double>(in_block) * model_.firing_us + laser.fires_after_us;
      const double angle = (azimuth + rate_ * block_us) * (std::numbers::pi / 18000) + laser.azimuth_rad;
      sweep_.add(point_of(laser, distance * model_.unit_m + laser.distance_offset_m, angle),
                 static_cast<float>(static_cast<unsigned char>(bytes[6 + 3 * k])), laser.ring,
                 stamp_ns + std::llround((begins_us + block_us) * 1000));
    }
  }

  // x forward, y left, z up; the angle turns clockwise from straight ahead.
  static Eigen::Vector3f point_of(const VelodyneLaser& laser, double distance_m, double angle) {
    const double cos_elevation = std::cos(laser.elevation_rad);
    const double sin_elevation = std::sin(laser.elevation_rad);
    const double across = distance_m * cos_elevation - laser.vertical_offset_m * sin_elevation;
    const double forward = across * std::cos(angle) + laser.horizontal_offset_m * std::sin(angle);
    const double right = across * std::sin(angle) - laser.horizontal_offset_m * std::cos(angle);
    const double up = distance_m * sin_elevation + laser.vertical_offset_m * cos_elevation;
    return {static_cast<float>(forward), static_cast<float>(-right), static_cast<float>(up)};
  }

  VelodyneModel model_;
  PacketClock clock_;
  PacketOrder order_;
  GrowingSweep sweep_;
  double rate_ = 0;
  double mean_rate_ = 0;
  double rates_ = 0;
  int last_since_rear_ = -1;
  bool whole_ = false;  // the sweep began straight behind
  bool dual_ = false;
};

}  // namespace

std::unique_ptr<PacketDecoder> velodyne_decoder(VelodyneModel model) {
  return std::make_unique<VelodyneDecoder>(std::move(model));
}

}  // namespace rilo::detail
