// Anderson acceleration of depth one, by hand.
#include "registration/acceleration.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

const Matrix12d kUnit = Matrix12d::Identity();

Vector12d along_x(double length) { return length * Vector12d::Unit(3); }

// Each update is half of what is left: after 1 and 0.5 as much as the last is missing, beside the last itself.
TEST(Acceleration, TheSecantFindsWhatIsLeft) {
  Acceleration acceleration;
  EXPECT_EQ(acceleration.moved(along_x(1.0), kUnit), along_x(1.0));
  EXPECT_NEAR(acceleration.moved(along_x(0.5), kUnit)[3], 1.0, 1e-12);
}

// Each update is a hundredth of what is left: five of the last ones at once, not a hundred, and not one.
TEST(Acceleration, ASlowSequenceIsStretchedByFourSteps) {
  Acceleration acceleration;
  acceleration.moved(along_x(1.0), kUnit);
  EXPECT_NEAR(acceleration.moved(along_x(0.99), kUnit)[3], 0.99 + 4.0 * 0.99, 1e-12);
}

TEST(Acceleration, UpdatesThatGrowAndTheFirstAfterARestartStay) {
  Acceleration acceleration;
  acceleration.moved(along_x(1.0), kUnit);
  EXPECT_EQ(acceleration.moved(along_x(1.5), kUnit), along_x(1.5));
  acceleration.restart();
  EXPECT_EQ(acceleration.moved(along_x(0.5), kUnit), along_x(0.5));
}

// 0.1 along x and 0.9 along y are left of (1, 1); counted a thousand times, y decides.
TEST(Acceleration, TheInformationWeighs) {
  Matrix12d information = kUnit;
  information(4, 4) = 1000.0;
  Acceleration acceleration;
  acceleration.moved(Vector12d::Unit(3) + Vector12d::Unit(4), information);
  const Vector12d last = 0.1 * Vector12d::Unit(3) + 0.8 * Vector12d::Unit(4);
  const double gamma = (0.1 * -0.9 + 1000.0 * 0.8 * -0.2) / (0.81 + 1000.0 * 0.04);
  const Vector12d moved = acceleration.moved(last, information);
  EXPECT_NEAR(moved[3], 0.1 - gamma * 0.1, 1e-12);
  EXPECT_NEAR(moved[4], 0.8 - gamma * 0.8, 1e-12);
}

}  // namespace
}  // namespace rilo
