// Sweeps with the times of the order of their points.
#include <utility>

#include "io/sources/source_wrappers.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::detail {
namespace {

std::vector<float> times_by_index(std::size_t points, double period_s) {
  std::vector<float> times(points);
  for (std::size_t i = 0; i < points; ++i) {
    times[i] = static_cast<float>(period_s * static_cast<double>(i) / static_cast<double>(points));
  }
  return times;
}

class OrderTimedSource final : public WrappedSource {
 public:
  OrderTimedSource(std::unique_ptr<ScanSource> inner, std::optional<double> turn_s)
      : WrappedSource(std::move(inner)), turn_s_(turn_s.value_or(detail::turn_s(inner_->info().period_s))) {}

  std::optional<Sweep> next() override {
    std::optional<Sweep> sweep = inner_->next();
    if (!sweep || sweep->points.empty()) return sweep;
    if (auto times = order_times(sweep->points, turn_s_)) {
      sweep->times_s = std::move(*times);
      in_order_ = true;
    } else if (in_order_) {
      sweep->times_s = times_by_index(sweep->points.size(), turn_s_);
    } else {
      throw IoError(
          {inner_->current_name(), "", "points that do not lie in the order in which a sensor that turns measured them",
           "points whose azimuth goes once round, as drivers of spinning sensors write them",
           "Set point_times (--point-times) to azimuth for raw points in another order, or to none to go without"});
    }
    return sweep;
  }
  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.has_point_times = true;
    info.point_times = "order of the points, period " + std::to_string(turn_s_) + " s";
    note_left_out(info.period_s, turn_s_, info.warnings);
    return info;
  }

 private:
  double turn_s_;
  // As a sweep has shown; a later one that does not, where most of it is covered, is taken to be.
  bool in_order_ = false;
};

}  // namespace

std::unique_ptr<ScanSource> with_order_times(std::unique_ptr<ScanSource> inner, std::optional<double> turn_s) {
  return std::make_unique<OrderTimedSource>(std::move(inner), turn_s);
}

}  // namespace rilo::detail
