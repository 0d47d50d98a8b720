// Firings, lasers and revolutions in single packets of a Velodyne, by hand.
#include <cmath>
#include <numbers>

#include "io/io_test_util.hpp"
#include "io/packets/packet_bytes.hpp"
#include "io/packets/velodyne.hpp"

namespace rilo::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// What the decoder has done with the packets, each of which is received when it was sent.
std::deque<detail::DecodedSweep> revolutions_in(detail::VelodyneModel model, const std::vector<std::string>& packets) {
  const auto decoder = detail::velodyne_decoder(std::move(model));
  std::deque<detail::DecodedSweep> done;
  for (const std::string& packet : packets) {
    EXPECT_TRUE(decoder->accepts(packet));
    std::uint32_t hour_us = 0;
    std::memcpy(&hour_us, packet.data() + 1200, 4);
    decoder->take(packet, std::int64_t{hour_us} * 1000, done);
  }
  decoder->finish(done);
  return done;
}

std::deque<detail::DecodedSweep> revolutions_in(const std::vector<std::string>& packets) {
  return revolutions_in(detail::velodyne_model(packets[0], "f", ""), packets);
}

void expect_measured(const Sweep& sweep, std::size_t i, double clockwise_deg, double after_us) {
  SCOPED_TRACE(i);
  EXPECT_NEAR(azimuth_deg(sweep.points[i]), 360 - clockwise_deg, 2e-4);
  EXPECT_NEAR(sweep.times_s[i], after_us * 1e-6, 2e-9);
}

// 16 lasers fire every 55.296 µs, 2.304 µs apart, and twice a block, in which the sensor turns by 0.2°.
TEST(VelodyneDecoderTest, EveryFiringHasItsAngleAndTime) {
  std::vector<std::string> packets{velodyne_packet(18000, 20, 0, 0x22), velodyne_packet(18240, 400, 1327, 0x22)};
  packets[1][501] = '\xDD';  // a lower bank, which this sensor does not have
  const auto done = revolutions_in(packets);
  ASSERT_EQ(done.size(), 1U);
  const Sweep& sweep = done[0].sweep;
  ASSERT_EQ(sweep.points.size(), 2 * 12 * 32U);
  expect_measured(sweep, (3 * 2 + 1) * 16 + 5, 180.6 + 0.1 + 0.2 * 5 / 48, 7 * 55.296 + 5 * 2.304);
  // Of the last block, as far as in the one before.
  expect_measured(sweep, 23 * 16 + 15, 182.2 + 0.1 + 0.2 * 15 / 48, 23 * 55.296 + 15 * 2.304);
  // Steps of 4° are what the sensor does not send: within a block the rate of before counts, between them it goes on.
  expect_measured(sweep, 384 + 3 * 16, 182.4 + 4 + 0.1, 1327 + 4 / 0.2 * 110.592 + 55.296);
  for (const std::uint16_t ring : sweep.rings) EXPECT_LT(ring, 16);
}

// Blocks come in pairs of the same two firings.
TEST(VelodyneDecoderTest, OfTwoReturnsToo) {
  const auto done = revolutions_in({velodyne_packet(18000, 20, 0, 0x22, 5000, 0x39)});
  ASSERT_EQ(done.size(), 1U);
  ASSERT_EQ(done[0].sweep.points.size(), 6 * 32U);
  expect_measured(done[0].sweep, 5 * 16, 180.4 + 0.1, 5 * 55.296);
}

// Blocks of the upper and the lower bank in turn, of the same firing; that of 3 · 4 · 5 looks to the right.
TEST(VelodyneDecoderTest, TwoBanksWithTheOffsetsOfTheirLasers) {
  detail::VelodyneModel model;
  model.firing_us = 48;
  model.two_banks = true;
  model.lasers.resize(64);
  const double turned_deg = 0.4 + 0.2 * 4.5 / 48;  // at the third firing, 0.2° a firing
  model.lasers[3] = {std::atan2(3, 4), (90 - turned_deg) * kDegree, 0.1, 0.03, 1, 4.5, 7};
  model.lasers[32 + 3] = {0, -turned_deg * kDegree, 0, 0.05, 2, 4.5, 9};
  std::string packet = velodyne_packet(0, 20, 0, 0, 5000, 0x39);  // 10 m, in the second of two blocks 8 m
  for (std::size_t block = 1; block < 12; block += 2) packet[block * 100 + 1] = '\xDD';
  const auto done = revolutions_in(model, {packet});
  ASSERT_EQ(done.size(), 1U);
  const Sweep& sweep = done[0].sweep;
  ASSERT_EQ(sweep.points.size(), 12 * 32U);
  const std::size_t upper = 4 * 32 + 3;
  const std::size_t lower = 5 * 32 + 3;
  // 11 m along the beam and 0.1 m up from it, 0.03 m to its left.
  EXPECT_LT((sweep.points[upper] - Eigen::Vector3f(0.03F, -(8.8F - 0.06F), 6.6F + 0.08F)).norm(), 1e-5F);
  EXPECT_LT((sweep.points[lower] - Eigen::Vector3f(10, 0.05F, 0)).norm(), 1e-5F);
  EXPECT_EQ(sweep.rings[upper], 7);
  EXPECT_EQ(sweep.rings[lower], 9);
  EXPECT_NEAR(sweep.times_s[upper], 100.5e-6, 2e-9);
  EXPECT_NEAR(sweep.times_s[lower], 100.5e-6, 2e-9);
}

/// Of a VLP-16 that turns ten times a second and sends from `first_deg` clockwise to `last_deg` alone.
std::vector<std::string> part_of_turns(int first_deg, int last_deg, int turns) {
  constexpr int kStep = 40;  // hundredths of a degree a block of two firings
  constexpr double kBlockUs = 1e5 * kStep / 36000;
  const int blocks_a_turn = (last_deg - first_deg + 360) % 360 * 100 / kStep;
  std::vector<std::string> packets;
  for (int sent = 0; sent + 12 <= turns * blocks_a_turn; sent += 12) {
    std::string packet;
    for (int block = 0; block < 12; ++block) {
      const int turn = (sent + block) / blocks_a_turn;
      const int step = (sent + block) % blocks_a_turn;
      const int azimuth = (first_deg * 100 + step * kStep) % 36000;
      const auto us = static_cast<std::uint32_t>(std::lround(turn * 1e5 + step * kBlockUs));
      if (block == 0) packet = velodyne_packet(azimuth, kStep, us, 0x22);
      std::memcpy(packet.data() + block * 100 + 2, &azimuth, 2);
    }
    packets.push_back(packet);
  }
  return packets;
}

// As set on the sensor's page. It fills its packets from both sides of what it does not send.
TEST(VelodyneDecoderTest, APartOfTheTurn) {
  for (const auto& [first_deg, last_deg] : {std::pair(320, 40), {270, 90}, {240, 120}, {90, 270}, {200, 160}}) {
    SCOPED_TRACE(first_deg);
    const auto done = revolutions_in(part_of_turns(first_deg, last_deg, 8));
    const bool behind = first_deg < last_deg;  // what is sent reaches over the rear
    ASSERT_EQ(done.size(), behind ? 9U : 8U);
    for (std::size_t i = 1; i + 1 < done.size(); ++i) {
      const Sweep& sweep = done[i].sweep;
      EXPECT_TRUE(done[i].whole);
      // A turn apart; the mean of the rate is not yet that of the sensor, which fires in 110.592 µs.
      EXPECT_NEAR(static_cast<double>(sweep.stamp_ns - done[i - 1].sweep.stamp_ns), i == 1 && behind ? 2.5e7 : 1e8,
                  1e6);
      const double sent_s = 0.1 * (behind ? 360 : (last_deg - first_deg + 360) % 360) / 360;
      EXPECT_NEAR(sweep.times_s.back(), sent_s, 2e-3);
    }
  }
}

TEST(VelodyneDecoderTest, NoReturnIsNoPoint) {
  EXPECT_TRUE(revolutions_in({velodyne_packet(18000, 20, 0, 0x22, 0)}).empty());
}

TEST(VelodyneDecoderTest, ARevolutionIsWholeFromStraightBehindOn) {
  const auto first_is_whole = [](int begin) {
    std::vector<std::string> packets;
    for (int i = 0; i < 31; ++i) packets.push_back(velodyne_packet((begin + i * 1200) % 36000, 100, 0, 0x21));
    return revolutions_in(packets).front().whole;
  };
  EXPECT_TRUE(first_is_whole(18000));
  EXPECT_TRUE(first_is_whole(18200));
  EXPECT_FALSE(first_is_whole(18201));
  EXPECT_FALSE(first_is_whole(9000));
  // An angle that goes back a little ends none, and a motor that does not run has none.
  EXPECT_EQ(revolutions_in({velodyne_packet(9000, 0, 0, 0x21), velodyne_packet(8990, 0, 0, 0x21)}).size(), 1U);
  std::vector<std::string> same_angle;
  for (std::uint32_t i = 0; i < 2800; ++i) same_angle.push_back(velodyne_packet(18000, 0, i * 553, 0x21));
  const auto stuck = revolutions_in(same_angle);
  ASSERT_EQ(stuck.size(), 2U);
  EXPECT_FALSE(stuck[0].whole);
}

detail::VelodyneModel model_of(std::uint8_t product, const std::filesystem::path& calibration = {}) {
  return detail::velodyne_model(velodyne_packet(0, 20, 0, product), "f", calibration);
}

// As the manuals have them.
TEST(VelodyneModelTest, LasersFireOneAfterTheOtherOrInPairs) {
  EXPECT_EQ(model_of(0x21).firing_us, 46.08);
  EXPECT_EQ(model_of(0x21).firings_a_block, 1U);
  EXPECT_DOUBLE_EQ(model_of(0x21).lasers[31].fires_after_us, 31 * 1.152);
  EXPECT_DOUBLE_EQ(model_of(0x24).lasers[15].fires_after_us, 15 * 2.304);
  EXPECT_EQ(model_of(0x24).firings_a_block, 2U);
  EXPECT_DOUBLE_EQ(model_of(0x28).lasers[30].fires_after_us, 15 * 2.304);
  EXPECT_DOUBLE_EQ(model_of(0x28).lasers[31].fires_after_us, 15 * 2.304);
}

// A calibration of `lasers`, the last of which is the lowest and the only one with offsets.
std::string calibration_of(int lasers, int last_id) {
  std::string text = "distance_resolution: 0.005\nlasers:\n";
  for (int i = 0; i + 1 < lasers; ++i) {
    text += "- {laser_id: " + std::to_string(i) + ", vert_correction: 0.1, rot_correction: 0.0}\n";
  }
  return text + "- {laser_id: " + std::to_string(last_id) +
         ", vert_correction: -0.3, rot_correction: 0.01, vert_offset_correction: 0.2, horiz_offset_correction: 0.03, "
         "dist_correction: 1.5}\n";
}

TEST(VelodyneModelTest, AnyMayHaveACalibration) {
  const TempDir folder;
  std::string two_banks = velodyne_packet(0, 20, 0, 0xA1);  // an HDL-64E has the states of the sensor there
  two_banks[101] = '\xDD';
  const auto hdl64 = detail::velodyne_model(two_banks, "f", folder.write("64.yaml", calibration_of(64, 63)));
  EXPECT_DOUBLE_EQ(hdl64.lasers[63].fires_after_us, 31 * 1.5);  // both banks at once
  for (const auto& model : {hdl64, model_of(0x22, folder.write("16.yaml", calibration_of(16, 15)))}) {
    EXPECT_EQ(model.unit_m, 0.005);
    EXPECT_EQ(model.lasers.back().elevation_rad, -0.3);
    EXPECT_EQ(model.lasers.back().azimuth_rad, -0.01);
    EXPECT_EQ(model.lasers.back().vertical_offset_m, 0.2);
    EXPECT_EQ(model.lasers.back().horizontal_offset_m, 0.03);
    EXPECT_EQ(model.lasers.back().distance_offset_m, 1.5);
    EXPECT_EQ(model.lasers.back().ring, 0);
    EXPECT_EQ(model.lasers.front().ring, 1);
  }
  const auto beyond = folder.write("beyond.yaml", calibration_of(16, 16));
  expect_io_error([&] { model_of(0x22, beyond); }, {"beyond.yaml", "laser_id 16"});
  const auto twice = folder.write("twice.yaml", calibration_of(16, 3));
  expect_io_error([&] { model_of(0x22, twice); }, {"twice.yaml", "laser_id 3 twice"});
  expect_io_error([&] { model_of(0x22, folder / "none.yaml"); }, {"none.yaml", "No such file"});
}

}  // namespace
}  // namespace rilo::test
