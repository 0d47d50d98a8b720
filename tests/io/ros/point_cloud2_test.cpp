#include "rilo/io/point_cloud2.hpp"

#include <cmath>
#include <random>
#include <utility>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"

namespace rilo::test {
namespace {

constexpr auto kBoth = {MessageEncoding::kRos1, MessageEncoding::kCdr};

RawCloud decode(const CloudMessage& message, MessageEncoding encoding) {
  const std::string bytes = message_bytes(message, encoding);
  return columns_of(parse_point_cloud2(bytes, encoding, "f"), "", "f", "message 3");
}

TEST(PointCloud2Test, EveryByteOfASmallMessage) {
  // ROS 1, by hand: one point of x, y, z as float32.
  Bytes bytes;
  bytes.put(std::uint32_t{9}).put(std::uint32_t{17}).put(std::uint32_t{5}).string("ab");
  bytes.put(std::uint32_t{1}).put(std::uint32_t{1}).put(std::uint32_t{3});
  const char* names[] = {"x", "y", "z"};
  for (std::uint32_t i = 0; i < 3; ++i) {
    bytes.string(names[i]).put(std::uint32_t{4 * i}).put(std::uint8_t{7}).put(std::uint32_t{1});
  }
  bytes.put(std::uint8_t{0}).put(std::uint32_t{12}).put(std::uint32_t{12}).put(std::uint32_t{12});
  bytes.put(1.5F).put(-2.0F).put(3.25F).put(std::uint8_t{1});
  const PointCloud2 message = parse_point_cloud2(bytes.text, MessageEncoding::kRos1, "f");
  EXPECT_EQ(message.stamp_ns, 17'000'000'005);
  EXPECT_EQ(message.frame_id, "ab");
  EXPECT_TRUE(message.is_dense);
  EXPECT_EQ(columns_of(message, "", "f").points, std::vector<Eigen::Vector3f>{Eigen::Vector3f(1.5F, -2, 3.25F)});
}

TEST(PointCloud2Test, AllColumnsInBothEncodings) {
  const Sweep sweep = numbered_sweeps(1)[0];
  for (const auto encoding : kBoth) {
    for (const char* frame : {"", "a", "ab", "abc", "abcd"}) {  // each shifts what follows in CDR
      CloudMessage message = message_of(sweep);
      message.frame_id = std::string(frame);
      const std::string bytes = message_bytes(message, encoding);
      const PointCloud2 parsed = parse_point_cloud2(bytes, encoding, "f");
      EXPECT_EQ(parsed.stamp_ns, sweep.stamp_ns);
      EXPECT_EQ(parsed.frame_id, frame);
      expect_same(columns_of(parsed, "", "f"), sweep);
    }
  }
}

// Float64 coordinates, integers, an array and a field of a type that nobody knows.
TEST(PointCloud2Test, OtherTypesAndUnknownFields) {
  CloudMessage message;
  message.width = 2;
  message.fields = {{"z", 16, 8, 1},   {"y", 8, 8, 1}, {"x", 0, 8, 1}, {"t", 24, 6, 1}, {"reflectivity", 28, 2, 1},
                    {"what", 0, 77, 3}};
  message.point_step = 29;
  message.row_step = 58;
  Bytes data;
  data.put(1.0).put(2.0).put(3.0).put(std::uint32_t{5}).put(std::uint8_t{200});
  data.put(double{NAN}).put(5.0).put(6.0).put(std::uint32_t{4'000'000'000}).put(std::uint8_t{1});
  message.data = data.text;
  for (const auto encoding : kBoth) {
    const RawCloud cloud = decode(message, encoding);
    EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1, 2, 3));
    EXPECT_TRUE(std::isnan(cloud.points[1].x()));
    EXPECT_EQ(cloud.intensities, (std::vector<float>{200, 1}));
    ASSERT_TRUE(cloud.times);
    EXPECT_EQ(cloud.times->integers, (std::vector<std::int64_t>{5, 4'000'000'000}));
  }
}

CloudMessage organised(std::uint32_t row_step) {
  CloudMessage message;
  message.height = 2;
  message.width = 2;
  message.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}};
  message.point_step = 12;
  message.row_step = row_step;
  return message;
}

TEST(PointCloud2Test, OrganisedWithPaddedRows) {
  CloudMessage message = organised(28);
  Bytes data;
  data.raw(bytes_of<float>({1, 0, 0, 2, 0, 0})).put(std::uint32_t{99});
  data.raw(bytes_of<float>({3, 0, 0, 4, 0, 0})).put(std::uint32_t{99});
  message.data = data.text;
  const auto xs = [&] {
    std::vector<float> all;
    for (const auto& point : decode(message, MessageEncoding::kCdr).points) all.push_back(point.x());
    return all;
  };
  EXPECT_EQ(xs(), (std::vector<float>{1, 2, 3, 4}));
  message.data.resize(message.data.size() - 4);  // the last row's padding may be missing
  EXPECT_EQ(xs(), (std::vector<float>{1, 2, 3, 4}));
  message = organised(0);  // unset by the driver: no padding
  message.data = bytes_of<float>({1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0});
  EXPECT_EQ(xs(), (std::vector<float>{1, 2, 3, 4}));
}

TEST(PointCloud2Test, EmptyClouds) {
  CloudMessage message = organised(0);
  message.width = 0;
  EXPECT_TRUE(decode(message, MessageEncoding::kRos1).points.empty());
}

TEST(PointCloud2Test, RefusesWhatContradictsItself) {
  const auto refused = [](const CloudMessage& message, std::initializer_list<std::string_view> parts) {
    expect_io_error([&] { decode(message, MessageEncoding::kCdr); }, parts);
  };
  CloudMessage good = organised(24);
  good.data.assign(48, '\0');
  EXPECT_EQ(decode(good, MessageEncoding::kCdr).points.size(), 4U);
  CloudMessage bad = good;
  bad.big_endian = true;
  refused(bad, {"f, message 3", "is_bigendian"});
  bad = good;
  bad.data.resize(47);
  refused(bad, {"width 2, height 2, point_step 12, row_step 24 and 47 bytes"});
  bad = good;
  bad.row_step = 20;
  bad.data.resize(50);
  bad.height = 3;
  refused(bad, {"row_step 20"});
  bad = good;
  bad.width = bad.height = bad.point_step = 0xFFFFFFFF;
  refused(bad, {"4294967295"});
  bad = good;
  bad.point_step = 0;
  refused(bad, {"point_step 0"});
  bad = good;
  bad.fields[2].offset = 9;
  refused(bad, {"field 'z' at byte 9 to 13", "point_step 12"});
  bad.fields[2].offset = 0xFFFFFFFF;
  refused(bad, {"field 'z'"});
  bad = std::move(good);
  bad.fields[2].name = std::string("w");
  refused(bad, {"x y w", "x, y and z"});
}

TEST(PointCloud2Test, RefusesBytesThatAreNone) {
  const std::string whole = message_bytes(message_of(numbered_sweeps(1)[0]), MessageEncoding::kCdr);
  expect_io_error([&] { parse_point_cloud2("", MessageEncoding::kCdr, "f"); }, {"f, byte 0", "encapsulation"});
  std::string other = whole;
  other[1] = 0;  // big-endian CDR
  expect_io_error([&] { parse_point_cloud2(other, MessageEncoding::kCdr, "f"); }, {"encapsulation of 0 0", "0 1"});
  for (const auto encoding : kBoth) {
    const std::string bytes = message_bytes(message_of(numbered_sweeps(1)[0]), encoding);
    expect_refused_cuts(bytes, [&](const std::string& cut) { parse_point_cloud2(cut, encoding, "f"); }, {"f, byte"});
  }
  Bytes fields;
  for (int i = 0; i < 6; ++i) fields.put(std::uint32_t{0});
  fields.put(std::uint32_t{0xFFFFFFFF});
  expect_io_error([&] { parse_point_cloud2(fields.text, MessageEncoding::kRos1, "f"); }, {"4294967295 fields"});
}

// Bytes turned over: a cloud or an IoError, and never more points than bytes.
TEST(PointCloud2Test, TurnedOverBytes) {
  std::mt19937 random(5);
  for (const auto encoding : kBoth) {
    const std::string whole = message_bytes(message_of(numbered_sweeps(1)[0]), encoding);
    for (int round = 0; round < 3000; ++round) {
      std::string bytes = whole;
      for (int k = 0; k < 1 + round % 4; ++k) bytes[random() % 200] = static_cast<char>(random());
      reads_or_refuses([&] {
        EXPECT_LE(columns_of(parse_point_cloud2(bytes, encoding, "f"), "", "f").points.size(), bytes.size());
      });
    }
  }
}

}  // namespace
}  // namespace rilo::test
