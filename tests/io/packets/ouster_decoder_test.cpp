// Columns, frames and metadata of an Ouster, by hand.
#include <cmath>
#include <numbers>

#include "io/io_test_util.hpp"
#include "io/packets/ouster.hpp"
#include "io/packets/packet_bytes.hpp"

namespace rilo::test {
namespace {

const OusterShape& kLegacy = kOusterShapes[0];
// Of a legacy packet of four beams.
constexpr std::size_t kColumnBytes = 16 + 4 * 12 + 4;
constexpr std::size_t kFirstPixel = 16;

std::deque<detail::DecodedSweep> frames_in(const std::vector<std::string>& packets) {
  const auto decoder = detail::ouster_decoder(detail::parse_ouster_metadata(ouster_metadata(kLegacy), "m.json"));
  std::deque<detail::DecodedSweep> done;
  for (const std::string& packet : packets) {
    EXPECT_TRUE(decoder->accepts(packet));
    decoder->take(packet, 0, done);
  }
  decoder->finish(done);
  return done;
}

// Packets of 16 columns, three of whose four beams have a return.
std::vector<std::string> of_one_frame(std::size_t packets) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < packets; ++i) all.push_back(ouster_packet(kLegacy, 7, i % 64 * 16, i * 1'562'500));
  return all;
}

template <typename Value>
void put_at(std::string& packet, std::size_t at, Value value) {
  std::memcpy(packet.data() + at, &value, sizeof(value));
}

// Column 256 of 1024 is a quarter of a turn clockwise from the sensor's front, which is behind.
TEST(OusterDecoderTest, BeamsBeginBesideTheAxis) {
  const Sweep sweep = frames_in({ouster_packet(kLegacy, 7, 256, 0)}).front().sweep;
  const double angle = 10 * std::numbers::pi / 180;
  EXPECT_LT((sweep.points[0] -
             Eigen::Vector3d(0, 7.985 * std::cos(angle) + 0.015, 7.985 * std::sin(angle) + 0.03618).cast<float>())
                .norm(),
            1e-5F);
}

TEST(OusterDecoderTest, ColumnsThatAreNoneAreLeftOut) {
  std::string packet = of_one_frame(1)[0];
  EXPECT_EQ(frames_in({packet}).front().sweep.points.size(), 16 * 3U);
  put_at(packet, kColumnBytes - 4, std::uint32_t{0});                         // not valid
  put_at(packet, 3 * kColumnBytes + 8, std::uint16_t{1024});                  // beyond the turn
  put_at(packet, 5 * kColumnBytes + kFirstPixel, std::uint32_t{15});          // as near as the beam's origin
  put_at(packet, 6 * kColumnBytes + kFirstPixel, std::uint32_t{16});          // and a millimetre farther
  put_at(packet, 6 * kColumnBytes + kFirstPixel + 4, std::uint16_t{0x0105});  // legacy reflectivities have 16 bits
  const Sweep sweep = frames_in({packet}).front().sweep;
  ASSERT_EQ(sweep.points.size(), 14 * 3U - 1);
  EXPECT_EQ(sweep.intensities[3 * 3 + 2], 0x105);  // columns 1, 2, 4 and two of 5 are before it
}

// 922 of 1024 columns are nine tenths.
TEST(OusterDecoderTest, AFrameIsWholeWithNineTenthsOfItsColumns) {
  EXPECT_FALSE(frames_in(of_one_frame(57)).front().whole);
  EXPECT_TRUE(frames_in(of_one_frame(58)).front().whole);
}

TEST(OusterDecoderTest, ACounterThatStandsStillEndsFramesAllTheSame) {
  const auto done = frames_in(of_one_frame(70));
  ASSERT_EQ(done.size(), 2U);
  EXPECT_EQ(done[0].sweep.points.size(), 1024 * 3U);
  EXPECT_EQ(done[1].sweep.points.size(), 6 * 16 * 3U);
}

detail::OusterMetadata metadata_with(const std::string& more) {
  return detail::parse_ouster_metadata(R"({"beam_altitude_angles": [1, -1], "beam_azimuth_angles": [2, -2], )" + more,
                                       "m.json");
}

TEST(OusterMetadataTest, TheWindowMayLieAcrossTheEndOfTheTurn) {
  const auto sent = [](const std::string& window) {
    return metadata_with(R"("lidar_mode": "1024x10", "column_window": )" + window + "}").columns_sent;
  };
  EXPECT_EQ(sent("[0, 1023]"), 1024U);
  EXPECT_EQ(sent("[0, 511]"), 512U);
  EXPECT_EQ(sent("[5, 5]"), 1U);
  EXPECT_EQ(sent("[768, 127]"), 384U);
  expect_io_error([&] { sent("[0, 1024]"); }, {"column_window", "column 1024"});
}

TEST(OusterMetadataTest, WhatIsNotSaidIsThatOfTheFirstSensors) {
  const auto metadata = metadata_with(R"("lidar_mode": "16x20"})");
  EXPECT_EQ(metadata.columns_per_frame, 16U);
  EXPECT_DOUBLE_EQ(metadata.beam_origin_m, 0.012163);
  EXPECT_DOUBLE_EQ(metadata.T_sensor_lidar(2, 3), 0.03618);
  EXPECT_DOUBLE_EQ(metadata.elevations_rad[0], std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(metadata.azimuths_rad[1], -std::numbers::pi / 90);
  const auto told = metadata_with(R"("lidar_mode": "1024x10", "columns_per_frame": 512,
      "lidar_to_sensor_transform": [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1]})");
  EXPECT_EQ(told.columns_per_frame, 512U);
  EXPECT_EQ((told.T_sensor_lidar.col(3)), Eigen::Vector4d(0.005, 0.006, 0.007, 1));
}

}  // namespace
}  // namespace rilo::test
