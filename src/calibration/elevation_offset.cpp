#include "calibration/elevation_offset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/degrees.hpp"

namespace rilo {

namespace {

constexpr std::size_t kSweepsPerBlock = 5;  // half a second: the map's errors are shared by neighbouring sweeps
constexpr std::size_t kLeastBlocks = 3;     // for a standard deviation
// Noise in the Jacobians weakens the response to about this share of the ideal one; chosen on drives with an offset. It
// sets the rate of convergence, not the limit: there the gradient is zero.
constexpr double kResponse = 0.5;
// Standard deviations of what no number of points averages out: errors of single beams, and one that is common to all
// residuals (rounded edges, bent ground). Of 0 to 3 mm and 0 to 0.08° the likeliest on 112 drives with known offset.
constexpr double kBeamErrorRad = 0.05 * kRadPerDeg;
constexpr double kSystematicM = 0.001;
// Before a recording says anything: sensors' elevation angles are off by some tenths of a degree. What a few sweeps in
// a room say, 1° ± 0.5°, is none of them.
constexpr double kUsualErrorRad = 0.2 * kRadPerDeg;
// An estimate that was significant once, by chance of hundreds of sweeps, is taken back; one that is just significant
// must not come and go: it stays down to this share of the bound, which is two standard deviations.
constexpr double kStillSignificant = 0.87;

}  // namespace

ElevationOffsetEstimator::ElevationOffsetEstimator(const ElevationOffsetConfig& config)
    : config_(config), applied_rad_(initial_rad()) {}

void ElevationOffsetEstimator::add(const ElevationInformation& sweep) {
  if (!(sweep.information > 0.0)) {
    return;
  }
  // Information gathered at another applied angle counts less, since the response is not exactly known: the memory
  // grows with the drive, and its last third counts most.
  const double n = static_cast<double>(++sweeps_);
  const double keep = (n - 1.0) * (n - 1.0) / (n * n);
  for (double* sum : {&information_, &weighted_offset_, &block_information_, &block_offset_, &squares_, &jacobian2_}) {
    *sum *= keep;
  }
  squared_information_ *= keep * keep;
  for (std::size_t i = 0; i < kBands; ++i) {
    by_band_[i] = keep * by_band_[i] + sweep.by_band[i];
  }
  jacobian2_ += sweep.information * sweep.jacobian_m * sweep.jacobian_m;
  const double weighted = sweep.information * applied_rad_ + sweep.gradient / kResponse;
  information_ += sweep.information;
  weighted_offset_ += weighted;
  block_information_ += sweep.information;
  block_offset_ += weighted;
  if (++in_block_ == kSweepsPerBlock) {
    const double mean = block_offset_ / block_information_;
    squares_ += block_information_ * mean * mean;
    squared_information_ += block_information_ * block_information_;
    ++blocks_;
    block_information_ = 0.0;
    block_offset_ = 0.0;
    in_block_ = 0;
  }
}

AngleEstimate ElevationOffsetEstimator::of_sweeps() const {
  return {information_ > 0.0 ? weighted_offset_ / information_ : applied_rad_, sigma_of_sweeps_rad()};
}

// Scatter of blocks of sweeps.
double ElevationOffsetEstimator::sigma_of_sweeps_rad() const {
  if (blocks_ < kLeastBlocks) {
    return std::numeric_limits<double>::infinity();
  }
  const double done = information_ - block_information_;
  const double mean = (weighted_offset_ - block_offset_) / done;
  const double scatter = std::max(0.0, squares_ / done - mean * mean);
  // Weighted mean of independent blocks: its variance is the scatter over the effective number of blocks less one.
  const double effective = done * done / squared_information_;
  const double from_scatter = scatter / std::max(1.0, effective - 1.0);
  const double systematic = kSystematicM * kSystematicM * information_ / jacobian2_;
  const double squared_bands = std::inner_product(by_band_.begin(), by_band_.end(), by_band_.begin(), 0.0);
  const double from_beams = kBeamErrorRad * kBeamErrorRad * squared_bands / (information_ * information_);
  return std::sqrt(std::max(from_scatter, 1.0 / information_) + from_beams + systematic);
}

AngleEstimate ElevationOffsetEstimator::estimate() const { return beside_what_is_known(of_sweeps()); }

AngleEstimate ElevationOffsetEstimator::beside_what_is_known(const AngleEstimate& own) const {
  const bool told = std::isfinite(others_.sigma_rad);
  if (!std::isfinite(own.sigma_rad)) {
    return told ? others_ : own;
  }
  const AngleEstimate before = told ? others_ : AngleEstimate{initial_rad(), kUsualErrorRad};
  const double own_weight = 1.0 / (own.sigma_rad * own.sigma_rad);
  const double weight = 1.0 / (before.sigma_rad * before.sigma_rad);
  return {(own_weight * own.rad + weight * before.rad) / (own_weight + weight), 1.0 / std::sqrt(own_weight + weight)};
}

// The sensor may have been put right since, or be another unit.
void ElevationOffsetEstimator::doubt_others(const AngleEstimate& own) {
  if (std::abs(own.rad - others_.rad) > config_.significance * std::hypot(own.sigma_rad, others_.sigma_rad)) {
    others_ = {0.0, kUsualErrorRad};
  }
}

double ElevationOffsetEstimator::initial_rad() const { return config_.initial_deg * kRadPerDeg; }

double ElevationOffsetEstimator::known_deg() const {
  return following_ ? kDegPerRad * estimate().rad : config_.initial_deg;
}

void ElevationOffsetEstimator::begin_with(double initial_deg, const AngleEstimate& others) {
  ElevationOffsetConfig config = config_;
  config.initial_deg = initial_deg;
  const AngleEstimate kept = others;  // may be our own
  *this = ElevationOffsetEstimator(config);
  others_ = kept;
}

double ElevationOffsetEstimator::advance() {
  const AngleEstimate own = of_sweeps();
  doubt_others(own);
  const AngleEstimate now = beside_what_is_known(own);
  const double enough = (following_ ? kStillSignificant : 1.0) * config_.significance * now.sigma_rad;
  following_ = std::abs(now.rad) > enough || std::abs(now.rad - initial_rad()) > enough;
  const double before_rad = std::exchange(applied_rad_, following_ ? now.rad : initial_rad());
  return applied_rad_ - before_rad;
}

}  // namespace rilo
