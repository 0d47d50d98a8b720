// Sweeps in the order of their stamps: what cannot be used is dropped and counted.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cloud/fingerprint.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/stamp_difference.hpp"

namespace rilo::detail {
namespace {

constexpr double kGapPeriods = 1.5;
// Farther back than this is not a late sweep: the clock was set.
constexpr std::int64_t kClockJumpNs = 1'000'000'000;
// So many late ones in a row: the clock was set back, by little.
constexpr std::size_t kMostInARow = 5;
constexpr std::size_t kMostWarnings = 20;
constexpr std::size_t kMostGapsListed = 5;  // where every second sweep was kept, one line says as much as twenty

class StampOrder final : public WrappedSource {
 public:
  using WrappedSource::WrappedSource;

  std::optional<Sweep> next() override {
    while (auto sweep = inner_->next()) {
      if (accept(*sweep)) return sweep;
    }
    return std::nullopt;
  }

  std::size_t skip(std::size_t count) override {
    skipped_ = skipped_ || count > 0;
    return inner_->skip(count);
  }

  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    StampFaults faults = faults_;
    faults.late = info.faults.late;  // what only a recording shows
    faults.most_late_s = info.faults.most_late_s;
    info.faults = faults;
    info.warnings.insert(info.warnings.end(), warnings_.begin(), warnings_.end());
    return info;
  }

 private:
  bool accept(const Sweep& sweep) {
    if (newest_ && !judge(sweep)) return false;
    newest_ = sweep.stamp_ns;
    fingerprint_ = Fingerprint(sweep.points);
    skipped_ = false;
    in_a_row_ = 0;
    return true;
  }

  // Whether the sweep is used; counts what is wrong with it.
  bool judge(const Sweep& sweep) {
    const std::int64_t back_ns = stamp_difference(*newest_, sweep.stamp_ns);
    const double back_s = seconds_between(sweep.stamp_ns, *newest_);
    if (back_ns < 0) {
      if (!skipped_) look_for_gap(-back_s);
      return true;
    }
    if (back_ns == 0) {
      const bool duplicate = Fingerprint(sweep.points) == fingerprint_;
      ++(duplicate ? faults_.duplicates : faults_.repeated);
      warn(duplicate ? "dropped: the same sweep again" : "a sweep with the stamp of the one before");
      return !duplicate;
    }
    if (back_ns > kClockJumpNs || ++in_a_row_ > kMostInARow) {
      ++faults_.clock_jumps;
      warn(fmt::format("the stamps go back by {:.3f} s: taken as a clock that was set{}", back_s,
                       by_name() ? "; or are the files not named in the order of time?" : ""));
      return true;
    }
    ++faults_.out_of_order;
    warn(fmt::format("dropped: {:.3f} s older than a sweep before{}", back_s,
                     by_name() && faults_.out_of_order == 1 ? "; are the files not named in the order of time?" : ""));
    return false;
  }

  bool by_name() const { return inner_->info().kind == "folder"; }

  void look_for_gap(double step_s) {
    const double period_s = inner_->info().period_s;
    if (step_s <= kGapPeriods * period_s) return;
    const auto missing = static_cast<std::size_t>(std::max(1.0, std::round(step_s / period_s) - 1));
    ++faults_.gaps;
    faults_.missing += missing;
    faults_.longest_gap_s = std::max(faults_.longest_gap_s, step_s);
    if (faults_.gaps <= kMostGapsListed) warn(fmt::format("a gap of {:.3f} s before it ({} missing)", step_s, missing));
    if (faults_.gaps == kMostGapsListed + 1) warnings_.emplace_back("more gaps are counted, not listed");
  }

  void warn(const std::string& text) {
    if (warnings_.size() < kMostWarnings) warnings_.push_back(inner_->current_name() + ": " + text);
    if (warnings_.size() == kMostWarnings) warnings_.emplace_back("more faults of the stamps are counted, not listed");
  }

  StampFaults faults_;
  std::vector<std::string> warnings_;
  std::optional<std::int64_t> newest_;
  Fingerprint fingerprint_;   // of the newest
  std::size_t in_a_row_ = 0;  // dropped because older
  bool skipped_ = false;
};

}  // namespace

std::unique_ptr<ScanSource> with_stamp_order(std::unique_ptr<ScanSource> inner) {
  return std::make_unique<StampOrder>(std::move(inner));
}

}  // namespace rilo::detail
