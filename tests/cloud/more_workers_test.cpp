// More threads than there are: only where they are asked for.
#include "cloud/more_workers.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

int allowed() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

TEST(MoreWorkers, AreLimitsOfNobodyElse) {
  const int usual = allowed();
  const MoreWorkers as_many_as_there_are(0);
  const MoreWorkers fewer(1);
  EXPECT_EQ(allowed(), usual);
  {
    const MoreWorkers more(usual + 3);
    EXPECT_EQ(allowed(), usual + 3);
  }
  EXPECT_EQ(allowed(), usual);
}

}  // namespace
}  // namespace rilo
