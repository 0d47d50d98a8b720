#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/trajectories.hpp"
#include "rilo/evaluation/pose_error.hpp"

namespace rilo::test {
namespace {

using ::testing::HasSubstr;

double distance(const SE3& a, const SE3& b) { return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff(); }

double cost(const std::vector<SE3>& truth, const std::vector<SE3>& estimate, const SE3& T) {
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += (T * estimate[i].translation() - truth[i].translation()).squaredNorm();
  }
  return sum;
}

TEST(Umeyama, RecoversRandomRigidMotions) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    const std::vector<SE3> truth = random_drive(random, 60, 1.0);
    const SE3 T = se3_exp(random_twist(random, 1.5, 100.0));
    EXPECT_LT(distance(align_umeyama(truth, moved(truth, T.inverse())), T), 1e-9);
  }
}

// Positions in a plane leave a reflection through the plane open, which must not be taken for a rotation.
TEST(Umeyama, RecoversPlanarTrajectories) {
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    std::vector<SE3> truth;
    for (int i = 0; i < 40; ++i) truth.push_back(pose(i, 0.1 * i * i, 0, 0.02 * i));
    const SE3 T = se3_exp(random_twist(random, 1.5, 100.0));
    const SE3 found = align_umeyama(truth, moved(truth, T.inverse()));
    EXPECT_LT(distance(found, T), 1e-9);
    EXPECT_GT(found.linear().determinant(), 0.0);
  }
}

// Positions on a line leave the turn about it open: the orientations settle it.
TEST(Umeyama, RecoversCollinearTrajectories) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    const std::vector<SE3> truth = moved(straight_line(30, 1.0), se3_exp(random_twist(random, 1.0, 5.0)));
    const SE3 T = se3_exp(random_twist(random, 1.5, 10.0));
    EXPECT_LT(distance(align_umeyama(truth, moved(truth, T.inverse())), T), 1e-8);
  }
}

TEST(Umeyama, RecoversTheOrientationOfASensorAtRest) {
  std::mt19937 random(4);
  const std::vector<SE3> truth(5, se3_exp(random_twist(random, 1.0, 5.0)));
  const SE3 T = se3_exp(random_twist(random, 1.0, 5.0));
  EXPECT_LT(distance(align_umeyama(truth, moved(truth, T.inverse())), T), 1e-9);
}

TEST(Umeyama, TwoPosesAreEnough) {
  const std::vector<SE3> truth{pose(0, 0, 0), pose(1, 0, 0)};
  const SE3 T = pose(3, -2, 1, 0.7);
  EXPECT_LT(distance(align_umeyama(truth, moved(truth, T.inverse())), T), 1e-9);
}

TEST(Umeyama, IsTheMinimum) {
  std::mt19937 random(5);
  const std::vector<SE3> truth = random_drive(random, 80, 1.0);
  const std::vector<SE3> estimate = with_drift(random, truth, 0.005, 0.02);
  const SE3 best = align_umeyama(truth, estimate);
  const double least = cost(truth, estimate, best);
  for (int i = 0; i < 200; ++i) {
    EXPECT_GE(cost(truth, estimate, best * se3_exp(random_twist(random, 1e-3, 1e-2))), least);
  }
}

TEST(Alignment, FirstPoseMakesFirstPosesEqual) {
  std::mt19937 random(6);
  const std::vector<SE3> truth = random_drive(random, 10, 1.0);
  const std::vector<SE3> estimate = random_drive(random, 10, 1.0);
  const SE3 T = alignment_of(truth, estimate, Alignment::kFirstPose);
  EXPECT_LT(distance(T * estimate.front(), truth.front()), 1e-12);
  EXPECT_EQ(distance(alignment_of(truth, estimate, Alignment::kNone), SE3::Identity()), 0.0);
}

TEST(CheckTrajectories, NamesWhatIsWrong) {
  const std::vector<SE3> three(3, SE3::Identity());
  const std::vector<SE3> two(2, SE3::Identity());
  const auto message = [](const std::vector<SE3>& truth, const std::vector<SE3>& estimate) {
    try {
      check_trajectories(truth, estimate);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_THAT(message(three, two), HasSubstr("truth has 3 poses, estimate has 2"));
  EXPECT_THAT(message({SE3::Identity()}, {SE3::Identity()}), HasSubstr("at least two poses, found 1"));
  EXPECT_THAT(message({}, {}), HasSubstr("found 0"));
  std::vector<SE3> broken = three;
  broken[2].translation().y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(three, broken), HasSubstr("pose 2 of the estimate is not finite"));
  broken[1].linear()(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(message(broken, three), HasSubstr("pose 1 of the truth is not finite"));
}

TEST(PathLengths, AddsUp) {
  const std::vector<double> lengths = path_lengths({pose(0, 0, 0), pose(3, 4, 0), pose(3, 4, 2)});
  EXPECT_THAT(lengths, ::testing::ElementsAre(0.0, 5.0, 7.0));
  EXPECT_TRUE(path_lengths({}).empty());
}

}  // namespace
}  // namespace rilo::test
