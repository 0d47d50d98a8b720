#include "io/times/time_field.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cloud/measured_point.hpp"
#include "io/stamp_difference.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

// Of the times, at each end. A packet of a VLP-16 is 1.3 % of a sweep.
constexpr double kEnds = 0.02;
// A sweep holds up to 450° (see order_times.cpp).
constexpr double kMostSwept = 1.25;

}  // namespace

TimeField::TimeField(const RawTimes& raw, const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points)
    : raw_(raw), file_(file), points_(points), floating_(is_floating(raw.type)) {
  narrow([](std::size_t) { return true; });
  whole_first_ = first_;
  whole_last_ = last_;
}

bool TimeField::takes_part(std::size_t i) const {
  return is_measured(points_[i]) && (!floating_ || std::isfinite(raw_.floats[i]));
}

template <typename Inside>
void TimeField::narrow(Inside&& inside) {
  count_ = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!takes_part(i) || !inside(i)) continue;
    first_ = count_ == 0 || less(i, first_) ? i : first_;
    last_ = count_ == 0 || less(last_, i) ? i : last_;
    ++count_;
  }
}

TimeField TimeField::bulk() const {
  const auto cut = static_cast<std::ptrdiff_t>(kEnds * static_cast<double>(count_));
  if (cut == 0) return *this;
  std::vector<std::size_t> order;
  order.reserve(count_);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (takes_part(i) && holds(i)) order.push_back(i);
  }
  const auto by_time = [this](std::size_t a, std::size_t b) { return less(a, b); };
  const auto first = order.begin() + cut;
  const auto last = order.end() - 1 - cut;
  TimeField field = *this;
  std::nth_element(order.begin(), first, order.end(), by_time);
  field.first_ = *first;
  std::nth_element(first, last, order.end(), by_time);
  field.last_ = *last;
  return field;
}

TimeField TimeField::of_one_sweep(double period) const {
  if (span() <= kMostSwept * period) return *this;
  const TimeField middle = bulk();
  const double most = kMostSwept * std::max(period, middle.span());
  TimeField near = *this;
  near.narrow([&](std::size_t i) { return apart(i, middle.first_) <= most && apart(middle.last_, i) <= most; });
  return near;
}

TimeField TimeField::between(double least, double most) const {
  const auto inside = [&](std::size_t i) { return value(i) >= least && value(i) <= most; };
  TimeField field = *this;
  if (inside(first_) && inside(last_)) return field;
  const TimeField middle = bulk();
  if (inside(middle.first_) && inside(middle.last_)) field.narrow(inside);
  return field;
}

double TimeField::farthest() const { return std::max(std::abs(least()), std::abs(most())); }

bool TimeField::holds(std::size_t i) const {
  return (!floating_ || std::isfinite(raw_.floats[i])) && !less(i, first_) && !less(last_, i);
}

double TimeField::apart(std::size_t a, std::size_t b) const {
  if (floating_) return raw_.floats[a] - raw_.floats[b];
  return static_cast<double>(stamp_difference(raw_.integers[a], raw_.integers[b]));
}

void TimeField::reject(const std::string& why, const std::string& remedy) const {
  throw IoError({file_, "",
                 fmt::format("point times in field {} from {:.10g} to {:.10g}, a span of {:.10g}", name(),
                             value(whole_first_), value(whole_last_), apart(whole_last_, whole_first_)),
                 why, remedy});
}

bool add_time_ends(const RawTimes& raw, const std::vector<Eigen::Vector3f>& points, std::vector<RawTimes>& ends) {
  const std::filesystem::path none;
  const TimeField all(raw, none, points);
  if (all.empty()) return false;
  const TimeField bulk = all.bulk();
  RawTimes& two = ends.emplace_back(RawTimes{raw.field, raw.type, {}, {}});
  if (is_floating(raw.type)) {
    two.floats = {raw.floats[bulk.first()], raw.floats[bulk.last()]};
  } else {
    two.integers = {raw.integers[bulk.first()], raw.integers[bulk.last()]};
  }
  return !bulk.constant();
}

}  // namespace rilo::detail
