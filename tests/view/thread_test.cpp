// The viewer's thread: what throws there ends it alone.
#include <future>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "view_thread.hpp"

namespace rilo::view {
namespace {

TEST(ViewThread, RunsWhatIsPostedUntilItIsStopped) {
  ViewThread thread;
  int sum = 0;
  thread.start(true, [] { FAIL(); });
  for (int i = 1; i <= 3; ++i) thread.post([&sum, i] { sum += i; });
  thread.stop([&sum] { sum *= 10; });
  EXPECT_EQ(sum, 60);
  EXPECT_FALSE(thread.failed());
  EXPECT_EQ(thread.failure(), "");
}

TEST(ViewThread, AnExceptionEndsItAndNothingElse) {
  ViewThread thread;
  std::promise<void> failed;
  thread.start(false, [&failed] { failed.set_value(); });
  thread.post([] { throw std::runtime_error("no memory for the picture"); });
  failed.get_future().wait();
  EXPECT_TRUE(thread.failed());
  EXPECT_EQ(thread.failure(), "no memory for the picture");
  // What comes later is neither run nor kept.
  const auto later = std::make_shared<int>(0);
  thread.post([later] { ++*later; });
  EXPECT_EQ(later.use_count(), 1);
  thread.stop([later] { ++*later; });
  EXPECT_EQ(*later, 0);
}

TEST(ViewThread, WhatIsNoExceptionOfTheLibraryEndsItToo) {
  ViewThread thread;
  std::promise<void> failed;
  thread.start(false, [&failed] { failed.set_value(); });
  thread.post([] { throw 1; });
  failed.get_future().wait();
  EXPECT_NE(thread.failure(), "");
}

}  // namespace
}  // namespace rilo::view
