#include "odometry/time_budget.hpp"

#include <algorithm>
#include <cmath>

#include "cloud/preprocess.hpp"
#include "odometry/running_mean.hpp"

namespace rilo {

namespace {
constexpr double kTarget = 0.85;        // of the budget
constexpr double kMostPreparing = 0.3;  // of the target: beyond it, raw points are left out
// Before anything is known: a slow machine; ratios as on all machines and drives measured.
constexpr double kPrepareGuessMs = 1e-4;
constexpr double kCoarseOverPrepare = 2e5;
constexpr double kInsertOverPrepare = 5.0;
constexpr double kRestOverPrepare = 20.0;  // per source point
}  // namespace

void UsualTime::learn(double value) {
  if (!known()) {
    mean_ = value;
    deviation_ = 0.5 * value;
    return;
  }
  const double error = std::min(value, kSlowest * mean_) - mean_;
  mean_ += kRunningShare * error;
  deviation_ += kRunningShare * (std::abs(error) - deviation_);
}

double TimeBudget::target_ms() const { return kTarget * config_.sweep_ms; }

PointShares TimeBudget::affordable(std::size_t raw_points, bool first, bool in_doubt) const {
  PointShares shares;
  if (!limited()) {
    return shares;
  }
  const double passes = first ? Preprocessor::kFirstPasses : 1.0;
  const double prepare_ms = passes * ms(Work::kPrepare, static_cast<double>(raw_points));
  const double most_ms = kMostPreparing * target_ms();
  shares.raw = prepare_ms > most_ms ? std::max(kLeastShare, most_ms / prepare_ms) : 1.0;
  const double rest_ms = ms(Work::kRest) * (in_doubt ? doubtful_work_ : 1.0);
  shares.source = std::clamp((target_ms() - shares.raw * prepare_ms) / rest_ms, kLeastShare, 1.0);
  return shares;
}

void TimeBudget::learn_doubt(bool out_of_time) {
  doubtful_work_ = out_of_time ? std::min(2.0 * doubtful_work_, kDoubtfulWork / kLeastShare)
                               : std::max(0.5 * doubtful_work_, kDoubtfulWork);
}

double TimeBudget::share_in_time(double work_ms, double left_ms) const {
  return !limited() || work_ms <= left_ms ? 1.0 : std::max(kLeastShare, left_ms / work_ms);
}

double TimeBudget::ms(Work work, double units) const {
  const UsualTime& time = times_[static_cast<std::size_t>(work)];
  return units * (time.known() ? time.upper() : guess(work));
}

double TimeBudget::guess(Work work) const {
  const UsualTime& prepare = times_[static_cast<std::size_t>(Work::kPrepare)];
  const double prepare_ms = prepare.known() ? prepare.mean() : kPrepareGuessMs;
  switch (work) {
    case Work::kPrepare:
      return prepare_ms;
    case Work::kRest:
      return kRestOverPrepare * source_points_ * prepare_ms;
    case Work::kCoarseStart:
      return kCoarseOverPrepare * prepare_ms;
    case Work::kInsert:
      return kInsertOverPrepare * prepare_ms;
    case Work::kSettle:
      return 0.0;
  }
  return 0.0;
}

void TimeBudget::learn(Work work, double units, double took_ms) {
  if (limited() && units > 0.0 && took_ms > 0.0) {
    times_[static_cast<std::size_t>(work)].learn(took_ms / units);
  }
}

}  // namespace rilo
