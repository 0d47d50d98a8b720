#include "measured_row.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace rilo::bench {
namespace {

constexpr double kKibPerMb = 1e6 / 1024;

/// The smallest value with at least `share` of all at or below it; NaN when there are none.
double nearest_rank(std::vector<double> values, double share) {
  if (values.empty()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

}  // namespace

ProcessMemory process_memory() {
  ProcessMemory memory{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string name;
    double kib = 0;
    if (!(words >> name >> kib)) {
      continue;
    }
    if (name == "VmHWM:") {
      memory.peak_mb = kib / kKibPerMb;
    } else if (name == "VmRSS:") {
      memory.resident_mb = kib / kKibPerMb;
    }
  }
  return memory;
}

void MeasuredRow::add(const SweepResult& result) {
  times_ms_.push_back(result.stats.times.total_ms);
  points_ += result.stats.points_in;
  map_voxels_ = result.stats.map_voxels;
  not_ok_ += result.status == OdometryStatus::kOk ? 0 : 1;
}

void MeasuredRow::clear() { *this = MeasuredRow(); }

void MeasuredRow::write_header(std::ostream& out) {
  out << "study,value,sweeps,points,map_voxels,median_ms,p99_ms,not_ok,resident_mb,peak_mb\n";
}

void MeasuredRow::write(std::ostream& out, const std::string& study, double value) const {
  const ProcessMemory memory = process_memory();
  std::ostringstream line;  // keeps the caller's number format as it is
  line << std::fixed;
  line.precision(value == std::floor(value) ? 0 : 1);
  line << study << ',' << value << ',' << sweeps() << ',' << points_ / std::max<std::size_t>(sweeps(), 1) << ','
       << map_voxels_ << ',';
  line.precision(3);
  line << nearest_rank(times_ms_, 0.5) << ',' << nearest_rank(times_ms_, 0.99) << ',' << not_ok_ << ',';
  line.precision(1);
  line << memory.resident_mb << ',' << memory.peak_mb << '\n';
  out << line.str() << std::flush;
}

}  // namespace rilo::bench
