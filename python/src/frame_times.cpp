#include "frame_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace rilo::python {

namespace {

constexpr const char* kCaller = "register_frame";

PointTimeDecoder frame_decoder(PointTimeUnit unit, PointTimeReference reference, bool unit_certain) {
  PointTimeHints hints;
  hints.unit = unit;
  hints.reference = reference;
  hints.assumed_period_s = kAssumedPeriodS;
  hints.unit_certain = unit_certain;
  return PointTimeDecoder(hints);
}

// Of a sweep whose times count from its earliest point.
std::int64_t length_ns(const Sweep& sweep) {
  return std::llround(1e9 * static_cast<double>(*std::max_element(sweep.times_s.begin(), sweep.times_s.end())));
}

bool is_near_zero(const PointTimeConvention& convention) {
  return convention.reference == PointTimeReference::kStamp && convention.unit != PointTimeUnit::kFraction;
}

}  // namespace

void FrameTimes::forget() {
  decoder_.reset();
  first_end_ns_.reset();
}

void FrameTimes::decode(const RawTimes& raw, PointTimeUnit unit, const std::optional<std::int64_t>& stamp_ns,
                        Sweep& sweep) {
  if (!decoder_ || unit != unit_) {
    forget();
    unit_ = unit;
    decoder_ = frame_decoder(unit, PointTimeReference::kInfer, false);
  }
  if (first_end_ns_) return decode_near_zero(raw, stamp_ns, sweep);
  const bool first = !decoder_->convention();
  const bool timed = decoder_->decode(raw, kCaller, sweep);
  if (first && timed && is_near_zero(*decoder_->convention())) decode_near_zero(raw, stamp_ns, sweep);
}

void FrameTimes::decode_near_zero(const RawTimes& raw, const std::optional<std::int64_t>& stamp_ns, Sweep& sweep) {
  const bool first = !first_end_ns_;
  PointTimeDecoder clock = frame_decoder(decoder_->convention()->unit, PointTimeReference::kEpoch, true);
  Sweep by_clock = sweep;
  if (!clock.decode(raw, kCaller, by_clock)) {
    decoder_->decode(raw, kCaller, sweep);
    return;
  }
  const std::int64_t start_ns = by_clock.stamp_ns;
  const std::int64_t length = length_ns(by_clock);
  // A stamp is of the start or of the end of its sweep. Without one, the second goes on where the first ended.
  const bool told = stamp_ns ? start_ns > length / 10 && std::abs(start_ns - *stamp_ns) <= 3 * length / 2
                             : !first && start_ns >= *first_end_ns_ - length / 10;
  // No sweep begins a whole one late, and the middle of this one would count for all later ones.
  const bool rebased = first && !stamp_ns && start_ns > length;
  if (told || rebased) {
    sweep = std::move(by_clock);
  } else if (!first) {
    decoder_->decode(raw, kCaller, sweep);
  }
  if (told) decoder_ = std::move(clock);
  first_end_ns_ = first && !told ? std::optional(start_ns + length) : std::nullopt;
}

}  // namespace rilo::python
