// Sweeps with the times of the azimuth of their points.
#include <utility>

#include "io/sources/source_wrappers.hpp"
#include "io/times/sweep_period.hpp"
#include "io/times/sweep_timing.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::detail {
namespace {

class AzimuthTimedSource final : public WrappedSource {
 public:
  AzimuthTimedSource(std::unique_ptr<ScanSource> inner, std::optional<double> turn_s)
      : WrappedSource(std::move(inner)), turn_s_(turn_s.value_or(detail::turn_s(inner_->info().period_s))) {}

  std::optional<Sweep> next() override {
    std::optional<Sweep> sweep = inner_->next();
    if (sweep) sweep->times_s = azimuth_times(sweep->points, turn_s_, SpinDirection::kClockwise);
    return sweep;
  }
  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.has_point_times = true;
    info.point_times = azimuth_description(SpinDirection::kClockwise, turn_s_);
    note_left_out(info.period_s, turn_s_, info.warnings);
    return info;
  }

 private:
  double turn_s_;
};

}  // namespace

std::unique_ptr<ScanSource> with_azimuth_times(std::unique_ptr<ScanSource> inner, std::optional<double> turn_s) {
  return std::make_unique<AzimuthTimedSource>(std::move(inner), turn_s);
}

}  // namespace rilo::detail
