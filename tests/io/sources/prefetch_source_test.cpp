#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "io/io_test_util.hpp"
#include "io/sources/source_wrappers.hpp"

namespace rilo::test {
namespace {

using namespace std::chrono_literals;

// Counts its sweeps; throws at the ones it is told to.
class CountingSource final : public ScanSource {
 public:
  struct Script {
    std::size_t sweeps = 20;
    std::vector<std::size_t> io_errors;
    std::optional<std::size_t> other_error;
    std::optional<std::size_t> no_memory_for_info = {};
  };
  CountingSource(Script script, std::atomic<std::size_t>& reads) : script_(std::move(script)), reads_(reads) {}

  std::optional<Sweep> next() override {
    if (cursor_ >= script_.sweeps) return std::nullopt;
    ++reads_;
    current_ = cursor_++;
    for (const std::size_t bad : script_.io_errors) {
      if (current_ == bad) throw IoError({"sweep", std::to_string(bad), "bad", "", ""});
    }
    if (script_.other_error == current_) throw std::logic_error("other");
    Sweep sweep;
    sweep.stamp_ns = static_cast<std::int64_t>(current_);
    return sweep;
  }
  std::size_t skip(std::size_t count) override {
    const std::size_t skipped = std::min(count, script_.sweeps - cursor_);
    cursor_ += skipped;
    return skipped;
  }
  std::optional<std::size_t> size() const override { return script_.sweeps; }
  std::size_t current_index() const override { return current_; }
  std::string current_name() const override { return "sweep " + std::to_string(current_); }
  SourceInfo info() const override {
    if (cursor_ > 0 && script_.no_memory_for_info == current_) throw std::bad_alloc();
    SourceInfo info;
    info.bad_sweeps = current_;
    return info;
  }

 private:
  Script script_;
  std::atomic<std::size_t>& reads_;
  std::size_t cursor_ = 0;
  std::size_t current_ = 0;
};

struct Fixture {
  std::atomic<std::size_t> reads{0};
  std::unique_ptr<ScanSource> reading_ahead;
  ScanSource& source;
  explicit Fixture(CountingSource::Script script = {}, std::size_t depth = 4)
      : reading_ahead(detail::with_read_ahead(std::make_unique<CountingSource>(std::move(script), reads), depth)),
        source(*reading_ahead) {}
};

TEST(PrefetchSourceTest, SameOrderAndSameWords) {
  Fixture f;
  EXPECT_EQ(f.source.size(), 20U);
  for (std::int64_t i = 0; i < 20; ++i) {
    const auto sweep = f.source.next();
    ASSERT_TRUE(sweep);
    EXPECT_EQ(sweep->stamp_ns, i);
    EXPECT_EQ(f.source.current_name(), "sweep " + std::to_string(i));
    EXPECT_EQ(f.source.current_index(), static_cast<std::size_t>(i));
    // What the source said right after this sweep, not what it says of those read ahead.
    EXPECT_EQ(f.source.info().bad_sweeps, static_cast<std::size_t>(i));
  }
  EXPECT_FALSE(f.source.next());
  EXPECT_FALSE(f.source.next());
  EXPECT_EQ(f.source.skip(3), 0U);
}

TEST(PrefetchSourceTest, ReadsAheadButNoFarther) {
  Fixture f({}, 4);
  EXPECT_EQ(f.reads, 0U);
  EXPECT_TRUE(f.source.next());
  for (int i = 0; i < 1000 && f.reads < 5; ++i) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(f.reads, 5U);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(f.reads, 5U);  // the one taken, and four in the queue
}

TEST(PrefetchSourceTest, ErrorsComeInTheirTurn) {
  Fixture f({6, {2, 3}, {}});
  EXPECT_EQ(f.source.next()->stamp_ns, 0);
  EXPECT_EQ(f.source.next()->stamp_ns, 1);
  expect_io_error([&] { f.source.next(); }, {"sweep, 2: bad"});
  EXPECT_EQ(f.source.current_name(), "sweep 2");
  expect_io_error([&] { f.source.next(); }, {"sweep, 3: bad"});
  EXPECT_EQ(f.source.next()->stamp_ns, 4);
  EXPECT_EQ(f.source.next()->stamp_ns, 5);
  EXPECT_FALSE(f.source.next());
}

TEST(PrefetchSourceTest, SweepsThatCannotBeReadCountAsSkipped) {
  Fixture f({6, {2, 3}, {}});
  EXPECT_EQ(f.source.next()->stamp_ns, 0);
  EXPECT_EQ(f.source.skip(3), 3U);
  EXPECT_EQ(f.source.next()->stamp_ns, 4);
}

TEST(PrefetchSourceTest, OtherErrorsEndTheReading) {
  Fixture f({6, {}, 1});
  EXPECT_TRUE(f.source.next());
  EXPECT_THROW(f.source.next(), std::logic_error);
  EXPECT_FALSE(f.source.next());
  EXPECT_EQ(f.reads, 2U);
}

TEST(PrefetchSourceTest, MemoryThatIsExhaustedBetweenSweepsIsAnErrorToo) {
  Fixture f({20, {}, {}, 3});
  for (std::int64_t i = 0; i < 3; ++i) EXPECT_TRUE(f.source.next());
  EXPECT_THROW(f.source.next(), std::bad_alloc);
  EXPECT_FALSE(f.source.next());
}

TEST(PrefetchSourceTest, SkipBeforeAndAfterTheStart) {
  Fixture f;
  EXPECT_EQ(f.source.skip(5), 5U);
  EXPECT_EQ(f.reads, 0U);
  EXPECT_EQ(f.source.next()->stamp_ns, 5);
  EXPECT_EQ(f.source.skip(3), 3U);
  EXPECT_EQ(f.source.next()->stamp_ns, 9);
  EXPECT_EQ(f.source.skip(100), 10U);
  EXPECT_FALSE(f.source.next());
}

TEST(PrefetchSourceTest, DestroyedAtAnyTime) {
  for (int taken = 0; taken < 22; ++taken) {
    Fixture f({20, {7}, {}}, 1 + static_cast<std::size_t>(taken) % 3);
    for (int i = 0; i < taken; ++i) {
      try {
        f.source.next();
      } catch (const IoError&) {
      }
    }
  }
}

}  // namespace
}  // namespace rilo::test
