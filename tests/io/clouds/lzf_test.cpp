#include "io/clouds/lzf.hpp"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "io/sweep_writer.hpp"

namespace rilo {
namespace {

TEST(LzfTest, RoundTrip) {
  std::mt19937 random(1);
  for (const std::size_t size : {0U, 1U, 2U, 3U, 31U, 32U, 33U, 264U, 1000U, 100'000U}) {
    for (const unsigned letters : {1U, 2U, 7U, 256U}) {
      std::string text(size, '\0');
      for (char& letter : text) letter = static_cast<char>(random() % letters);
      const std::string packed = lzf_compress(text);
      EXPECT_LE(packed.size(), size + size / 32 + 1);
      std::string unpacked(size, 'x');
      EXPECT_FALSE(detail::lzf_decompress(packed, unpacked));
      EXPECT_TRUE(unpacked == text) << size << " " << letters;
    }
  }
}

TEST(LzfTest, KnownStream) {
  // Literal "ab", a copy of 4 from distance 2, then a long copy: 7 + 1 + 2 = 10 from distance 1.
  const std::string packed = {1, 'a', 'b', 2 << 5, 1, static_cast<char>(7 << 5), 1, 0};
  std::string text(16, 'x');
  EXPECT_FALSE(detail::lzf_decompress(packed, text));
  EXPECT_EQ(text, "abababbbbbbbbbbb");
}

TEST(LzfTest, RefusesWhatDoesNotFit) {
  std::string out(4, 'x');
  EXPECT_TRUE(detail::lzf_decompress(std::string{5, 'a'}, out));                                     // literals cut off
  EXPECT_TRUE(detail::lzf_decompress(std::string{7, 'a', 'a', 'a', 'a', 'a', 'a', 'a', 'a'}, out));  // too long
  EXPECT_TRUE(detail::lzf_decompress(std::string{0, 'a', 1 << 5, 1}, out));  // before the beginning
  EXPECT_TRUE(detail::lzf_decompress(std::string{0, 'a', 1 << 5}, out));     // distance cut off
  EXPECT_TRUE(detail::lzf_decompress(std::string{0, 'a'}, out));             // too short
}

}  // namespace
}  // namespace rilo
