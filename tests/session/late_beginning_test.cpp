// A recording whose first sweeps are of no use: what the second pass begins with.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "io/sweeps_source.hpp"
#include "rilo/session/session.hpp"
#include "rilo/session/session_observer.hpp"
#include "simulation/small_drive.hpp"

namespace rilo::test {
namespace {

class Restarts final : public SessionObserver {
 public:
  void on_restart(const Restart& restart) override { seen.push_back(restart); }

  std::vector<Restart> seen;
};

// A drive behind two sweeps that fit nothing.
std::vector<Sweep> late_drive() {
  const std::vector<Sweep> drive = small_drive(14);
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> place(-15.0F, 15.0F);
  std::vector<Sweep> sweeps(2);
  for (Sweep& sweep : sweeps) {
    for (int i = 0; i < 5000; ++i) {
      const float x = place(rng);  // in this order with any compiler
      const float y = place(rng);
      sweep.points.emplace_back(x, y, place(rng));
    }
  }
  sweeps.insert(sweeps.end(), drive.begin(), drive.begin() + 12);
  for (std::size_t i = 0; i < sweeps.size(); ++i) sweeps[i].stamp_ns = drive[i].stamp_ns;
  return sweeps;
}

// Maps begin in vain, and nothing is learnt about the sensor.
TEST(LateBeginningOfARun, TheSecondPassBeginsMoving) {
  const std::vector<Sweep> sweeps = late_drive();
  SessionOptions options;
  options.config.elevation.enabled = false;
  options.config.beams.enabled = false;
  Session session([&] { return std::make_unique<SweepsSource>(sweeps, 0.1); }, options);
  Restarts restarts;
  session.add(restarts);
  const SessionResult run = session.run();
  ASSERT_EQ(restarts.seen.size(), 1U);
  EXPECT_TRUE(restarts.seen[0].begins_moving);
  EXPECT_EQ(restarts.seen[0].elevation_offset_deg, 0.0);
  // What is known of the motion is no reason to vouch for what does not fit.
  EXPECT_EQ(run.results[1].status, OdometryStatus::kInitialising);
  EXPECT_EQ(run.results.back().status, OdometryStatus::kOk);

  options.one_pass = true;
  const SessionResult one = Session([&] { return std::make_unique<SweepsSource>(sweeps, 0.1); }, options).run();
  EXPECT_FALSE(one.restart);
}

}  // namespace
}  // namespace rilo::test
