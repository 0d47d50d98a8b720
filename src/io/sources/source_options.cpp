#include "rilo/io/source_options.hpp"

#include <array>
#include <utility>

namespace rilo {
namespace {

template <typename Enum, std::size_t N>
using Names = std::array<std::pair<Enum, std::string_view>, N>;

constexpr Names<PointTimes, 4> kPointTimes{{{PointTimes::kAuto, "auto"},
                                            {PointTimes::kNone, "none"},
                                            {PointTimes::kAzimuth, "azimuth"},
                                            {PointTimes::kOrder, "order"}}};
constexpr Names<PointTimeUnit, 6> kUnits{{{PointTimeUnit::kInfer, "infer"},
                                          {PointTimeUnit::kSeconds, "s"},
                                          {PointTimeUnit::kMilliseconds, "ms"},
                                          {PointTimeUnit::kMicroseconds, "us"},
                                          {PointTimeUnit::kNanoseconds, "ns"},
                                          {PointTimeUnit::kFraction, "fraction"}}};
constexpr Names<PointTimeReference, 3> kReferences{{{PointTimeReference::kInfer, "infer"},
                                                    {PointTimeReference::kStamp, "stamp"},
                                                    {PointTimeReference::kEpoch, "epoch"}}};
constexpr Names<SpinDirection, 2> kDirections{
    {{SpinDirection::kClockwise, "clockwise"}, {SpinDirection::kCounterClockwise, "counter-clockwise"}}};
constexpr Names<OnBadSweep, 2> kOnBadSweep{{{OnBadSweep::kFail, "fail"}, {OnBadSweep::kSkip, "skip"}}};

template <typename Enum, std::size_t N>
std::string_view name_of(const Names<Enum, N>& names, Enum value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return name;
  }
  return "?";
}

template <typename Enum, std::size_t N>
std::optional<Enum> value_of(const Names<Enum, N>& names, std::string_view text) {
  for (const auto& [value, name] : names) {
    if (name == text) return value;
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(PointTimes value) { return name_of(kPointTimes, value); }
std::string_view to_string(PointTimeUnit value) { return name_of(kUnits, value); }
std::string_view to_string(PointTimeReference value) { return name_of(kReferences, value); }
std::string_view to_string(SpinDirection value) { return name_of(kDirections, value); }
std::string_view to_string(OnBadSweep value) { return name_of(kOnBadSweep, value); }

std::optional<PointTimes> parse_point_times(std::string_view text) { return value_of(kPointTimes, text); }
std::optional<PointTimeUnit> parse_point_time_unit(std::string_view text) { return value_of(kUnits, text); }
std::optional<PointTimeReference> parse_point_time_reference(std::string_view text) {
  return value_of(kReferences, text);
}
std::optional<SpinDirection> parse_spin_direction(std::string_view text) { return value_of(kDirections, text); }

}  // namespace rilo
