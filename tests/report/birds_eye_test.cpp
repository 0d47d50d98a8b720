#include "birds_eye.hpp"

#include <limits>
#include <png.h>

#include <gtest/gtest.h>

namespace rilo {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// Decodes Base64 the slow and obvious way.
std::vector<std::uint8_t> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  unsigned int buffer = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    buffer = buffer << 6U | static_cast<unsigned int>(digits.find(c));
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes.push_back(static_cast<std::uint8_t>(buffer >> static_cast<unsigned int>(bits) & 255U));
    }
  }
  return bytes;
}

/// A flat ground of 40 m × 20 m with a wall of 5 m along y = 10 m.
std::vector<Eigen::Vector3f> yard(float ground_m) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i <= 400; ++i) {
    const float x = 0.1F * static_cast<float>(i);
    for (int j = 0; j <= 200; ++j) points.emplace_back(x, 0.1F * static_cast<float>(j), ground_m);
    for (int j = 0; j <= 50; ++j) points.emplace_back(x, 10.0F, ground_m + 0.1F * static_cast<float>(j));
  }
  return points;
}

std::uint8_t pixel_at(const BirdsEyeMap& map, double x, double y) {
  const int column = static_cast<int>((x - map.min_x_m) / map.metres_per_pixel);
  const int row = static_cast<int>((map.max_y_m - y) / map.metres_per_pixel);
  return map.image.pixels.at(static_cast<std::size_t>(row * map.image.width + column));
}

/// A flat ground of 60 m × 60 m, a point a metre, with a post of 2 m in its middle.
std::vector<Eigen::Vector3f> sparse_field() {
  std::vector<Eigen::Vector3f> points;
  for (int x = 0; x <= 60; ++x) {
    for (int y = 0; y <= 60; ++y) points.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0F);
  }
  points.emplace_back(30.0F, 30.0F, 2.0F);
  return points;
}

TEST(Base64, KnownVectors) {  // RFC 4648, section 10
  EXPECT_EQ(base64(bytes_of("")), "");
  EXPECT_EQ(base64(bytes_of("f")), "Zg==");
  EXPECT_EQ(base64(bytes_of("fo")), "Zm8=");
  EXPECT_EQ(base64(bytes_of("foo")), "Zm9v");
  EXPECT_EQ(base64(bytes_of("foobar")), "Zm9vYmFy");
}

TEST(Png, DecodesToTheSamePicture) {
  const IndexedImage image{3, 2, {{0, 0, 0, 0}, {255, 10, 20, 255}, {1, 2, 3, 128}}, {0, 1, 2, 2, 1, 0}};
  const std::string url = png_data_url(image);
  const std::string prefix = "data:image/png;base64,";
  ASSERT_EQ(url.compare(0, prefix.size(), prefix), 0);
  const std::vector<std::uint8_t> bytes = decoded(url.substr(prefix.size()));
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0) << header.message;
  EXPECT_EQ(header.width, 3U);
  EXPECT_EQ(header.height, 2U);
  header.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, rgba.data(), 0, nullptr), 0) << header.message;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(rgba[4 * i + k], image.palette[image.pixels[i]][k]) << i << ' ' << k;
  }
}

TEST(BirdsEye, ColoursByHeightAboveTheLocalGround) {
  for (const float ground : {0.0F, -50.0F}) {  // the same picture wherever the ground lies
    const std::optional<BirdsEyeMap> map = draw_birds_eye(yard(ground), {});
    ASSERT_TRUE(map.has_value());
    const int on_ground = pixel_at(*map, 20.0, 4.0);
    const int on_wall = pixel_at(*map, 20.0, 10.0);
    EXPECT_GT(on_ground, 0);
    EXPECT_LE(on_ground, 5) << "not the lowest colour";
    EXPECT_GT(on_wall, 5 * 35) << "not a colour near the top";
  }
}

TEST(BirdsEye, YGoesUpAndEmptyIsTransparent) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 2000; ++i) points.emplace_back(0.01F * static_cast<float>(i), 0.0F, 0.0F);
  points.emplace_back(0.0F, 10.0F, 0.0F);
  SE3 corner = SE3::Identity();
  corner.translation() = Eigen::Vector3d(0, 10, 0);
  const std::optional<BirdsEyeMap> map = draw_birds_eye(points, {corner});
  ASSERT_TRUE(map.has_value());
  EXPECT_GE(map->max_y_m, 10.0);
  EXPECT_NE(pixel_at(*map, 10.0, 0.0), 0);
  EXPECT_EQ(pixel_at(*map, 10.0, 5.0), 0);
  EXPECT_EQ(map->image.palette[0][3], 0);
}

TEST(BirdsEye, StrayPointsDoNotShrinkThePicture) {
  std::vector<Eigen::Vector3f> points = yard(0.0F);
  points.emplace_back(1e6F, 1e6F, 0.0F);
  points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  points.emplace_back(0.0F, std::numeric_limits<float>::infinity(), 0.0F);
  const std::optional<BirdsEyeMap> map = draw_birds_eye(points, {});
  ASSERT_TRUE(map.has_value());
  EXPECT_LT(map->image.width * map->metres_per_pixel, 60.0);
  EXPECT_LE(map->image.width, 1501);
}

TEST(BirdsEye, WhatIsSeenThroughAWindowDoesNotShrinkTheRoom) {
  std::vector<Eigen::Vector3f> points = yard(0.0F);
  const std::vector<Eigen::Vector3f> outside = yard(0.0F);
  for (const Eigen::Vector3f& p : outside) points.emplace_back(p + Eigen::Vector3f(300.0F, 0.0F, 0.0F));
  const std::optional<BirdsEyeMap> map = draw_birds_eye(points, {SE3::Identity()});
  ASSERT_TRUE(map.has_value());
  EXPECT_NEAR(map->min_x_m + map->image.width * map->metres_per_pixel, 22.0, 0.2);  // 20 m and the margin
}

TEST(BirdsEye, NothingToDraw) {
  EXPECT_FALSE(draw_birds_eye({}, {}).has_value());
  EXPECT_FALSE(draw_birds_eye({Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())}, {}).has_value());
  EXPECT_TRUE(draw_birds_eye({Eigen::Vector3f(1, 2, 3)}, {}).has_value());
}

TEST(BirdsEye, AFewPointsBelowTheGroundDoNotRaiseWhatIsAround) {
  const std::vector<SE3> poses{SE3(Eigen::Translation3d(30.0, 30.0, 0.0))};
  std::vector<Eigen::Vector3f> points = sparse_field();
  const auto clean = draw_birds_eye(points, poses);
  for (int i = 0; i < 6; ++i) points.emplace_back(31.0F, 32.0F, -15.0F);  // a mirrored wall
  const auto mirrored = draw_birds_eye(points, poses);
  ASSERT_TRUE(clean && mirrored);
  // Ground and post beside the mirrored points.
  for (const auto& [x, y] : {std::pair(26.0, 33.0), std::pair(30.0, 30.0), std::pair(38.0, 38.0)}) {
    const int before = pixel_at(*clean, x, y);
    EXPECT_GT(before, 0);
    EXPECT_EQ(pixel_at(*mirrored, x, y), before) << x << ' ' << y;
  }
}

}  // namespace
}  // namespace rilo
