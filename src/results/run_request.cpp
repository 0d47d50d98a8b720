#include "results/run_request.hpp"

#include "console/interrupt.hpp"
#include "rilo/config/calibration_file.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo {

void check_point_times(const SourceRequest& request, const Sweep& sweep, const std::string& name) {
  if (!request.times_needed || !sweep.times_s.empty() || sweep.points.empty()) return;
  throw RunError(RunErrorKind::kBadData, name +
                                             ": no per-point times; expected them because of --point-times data. Take "
                                             "auto, order, azimuth or none, or name the field with --time-field");
}

OpenSource source_of(const RunRequest& request) {
  return [data = request.data, options = request.source.options] { return open_scan_source(data, options); };
}

SessionOptions session_options(const RunRequest& request, const OdometryConfig& config) {
  SessionOptions options;
  options.config = config;
  if (!request.calibration.empty()) options.calibration = load_calibration(request.calibration);
  options.start = request.start;
  options.count = request.count;
  options.one_pass = request.one_pass;
  // Times of the data that are asked for are not replaced by others.
  options.point_times = request.source.times_needed ? PointTimes::kNone : request.source.options.point_times;
  options.rate_assumed = !request.source.options.rate_hz;
  options.keep_intensities = request.map_intensity;
  options.interrupted = [] { return InterruptGuard::signal() != 0; };
  return options;
}

}  // namespace rilo
