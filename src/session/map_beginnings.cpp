#include "session/map_beginnings.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "io/stamp_difference.hpp"

namespace rilo {

namespace {

// So much later the velocity says nothing about the first sweep, or a clock was set meanwhile.
constexpr double kTooLateS = 10.0;

std::string why(const std::vector<SweepResult>& results, std::size_t begun) {
  if (2 * begun <= results.size()) return "";
  const auto late =
      std::count_if(results.begin(), results.end(), [](const SweepResult& r) { return r.stats.over_budget; });
  return 2 * static_cast<std::size_t>(late) > results.size()
             ? "; most sweeps take longer than budget.sweep_ms, which is too little here"
             : "; neighbouring sweeps do not fit: rilo info describes the sweeps";
}

}  // namespace

std::string further_maps(const std::vector<SweepResult>& results, const std::vector<std::size_t>& indices) {
  std::vector<std::size_t> begun;
  bool any = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].status != OdometryStatus::kInitialising) continue;
    if (any) begun.push_back(indices[i]);
    any = true;
  }
  if (begun.empty()) return "";
  const std::string where = begun.size() == 1 ? fmt::format("a new map begins at sweep {}", begun.front())
                                              : fmt::format("{} new maps begin, at sweeps {} to {}", begun.size(),
                                                            begun.front(), begun.back());
  return where + ": the poses before and after are connected by a guess" + why(results, begun.size() + 1);
}

std::optional<KnownVelocity> velocity_after_late_beginning(const std::vector<SweepResult>& results) {
  const auto first = std::find_if(results.begin(), results.end(),
                                  [](const SweepResult& r) { return r.status == OdometryStatus::kOk; });
  const auto held = std::find_if(results.begin(), first, [](const SweepResult& r) {
    return r.status == OdometryStatus::kDegenerate || r.status == OdometryStatus::kRecovered;
  });
  const auto begun = std::count_if(results.begin(), held,
                                   [](const SweepResult& r) { return r.status == OdometryStatus::kInitialising; });
  if (first == results.end() || begun < 2) return std::nullopt;
  const double at_s = detail::seconds_between(results.front().stamp_ns, first->stamp_ns);
  if (!(at_s > 0.0 && at_s < kTooLateS)) return std::nullopt;
  return KnownVelocity{first->twist, at_s};
}

}  // namespace rilo
