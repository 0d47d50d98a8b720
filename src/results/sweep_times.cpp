#include "results/sweep_times.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "io/folders/scan_listing.hpp"
#include "io/stamp_difference.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo {

namespace {

/// Of the first sweep: those of one sensor are alike.
std::int64_t offset_in_data(const std::filesystem::path& data, PoseInstant instant, std::int64_t stamp_ns) {
  SourceOptions options;
  options.read_ahead = 0;
  const std::optional<Sweep> sweep = open_scan_source(data, options)->next();
  if (!sweep) return 0;
  return sweep->stamp_ns - stamp_ns + detail::nanoseconds(static_cast<double>(instant_s(sweep->times_s, instant)));
}

}  // namespace

float instant_s(const std::vector<float>& times_s, PoseInstant instant) {
  std::optional<std::pair<float, float>> span;
  for (const float t : times_s) {
    if (!std::isfinite(t)) continue;
    span = span ? std::pair(std::min(span->first, t), std::max(span->second, t)) : std::pair(t, t);
  }
  if (!span) return 0.0F;
  if (instant == PoseInstant::kStart) return span->first;
  return instant == PoseInstant::kEnd ? span->second : 0.5F * (span->first + span->second);
}

SweepTimes sweep_times(const std::filesystem::path& data, PoseInstant instant) {
  try {
    const detail::ScanListing listing = detail::list_folder(data, {});
    if (listing.info.stamps_assumed || !std::is_sorted(listing.stamps_ns.begin(), listing.stamps_ns.end())) return {};
    // As the data say; points that are taken as compensated; those of which a run or an option says that they are not.
    return {
        listing.stamps_ns,
        {offset_in_data(data, instant, listing.stamps_ns.front()), 0, detail::nanoseconds(listing.info.period_s / 2)}};
  } catch (const IoError&) {
    return {};  // a recording, or nothing but the poses
  }
}

}  // namespace rilo
