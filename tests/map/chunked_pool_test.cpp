#include "map/chunked_pool.hpp"

#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

namespace rilo {
namespace {

TEST(ChunkedPool, BeginsEmpty) {
  const ChunkedPool<int> pool;
  EXPECT_TRUE(pool.empty());
  EXPECT_EQ(pool.size(), 0u);
}

TEST(ChunkedPool, NewElementsAreDefaultConstructed) {
  struct Element {
    int value = 7;
  };
  ChunkedPool<Element> pool;
  pool.grow();
  EXPECT_FALSE(pool.empty());
  EXPECT_EQ(pool.size(), 1u);
  EXPECT_EQ(pool[0].value, 7);
}

TEST(ChunkedPool, ElementsStayWhereTheyAreWhileItGrows) {
  constexpr std::size_t kMany = 100'000;  // of many chunks
  ChunkedPool<std::size_t> pool;
  std::vector<const std::size_t*> places;
  for (std::size_t i = 0; i < kMany; ++i) {
    pool.grow();
    pool[i] = i;
    places.push_back(&pool[i]);
  }
  ASSERT_EQ(pool.size(), kMany);
  const ChunkedPool<std::size_t>& seen = pool;
  for (std::size_t i = 0; i < kMany; ++i) {
    ASSERT_EQ(seen[i], i);
    ASSERT_EQ(&seen[i], places[i]);
  }
}

}  // namespace
}  // namespace rilo
