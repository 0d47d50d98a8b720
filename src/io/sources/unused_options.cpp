// What was asked for and makes no difference to these data.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/sources/source_wrappers.hpp"
#include "io/text.hpp"

namespace rilo::detail {
namespace {

// Of an option that has another value than its default.
std::vector<std::string> unused_options(const SourceOptions& options, const SourceInfo& info) {
  const SourceOptions usual;
  std::vector<std::string> warnings;
  const auto ignored = [&warnings](const std::string& option, const std::string& why) {
    warnings.push_back(option + " is ignored: " + why);
  };
  if (!options.topic.empty() && info.topic.empty()) {
    ignored("--topic " + in_quotes(options.topic), "the data are not a recording of topics");
  }
  if (!options.sensor_file.empty() && info.kind != "packets") {
    ignored("--sensor-file " + in_quotes(options.sensor_file), "the data are not packets");
  }
  if (options.bin_fields != usual.bin_fields && info.format != "bin") {
    ignored("--bin-fields " + options.bin_fields, "the data are not .bin files");
  }
  const bool alone = info.sweeps == 1U;  // its length may be assumed
  if (options.rate_hz && !info.stamps_assumed && !alone) {
    ignored(fmt::format("--rate {:g}", *options.rate_hz), "the data have stamps");
  }
  if (options.spin_direction != usual.spin_direction && options.point_times != PointTimes::kAzimuth) {
    ignored("--spin", "it is for --point-times azimuth");
  }
  if (!info.point_times.starts_with("field ")) {
    const std::string why = "the points' times are not from a field of the data";
    if (!options.time_field.empty()) ignored("--time-field " + options.time_field, why);
    if (options.point_time_unit != usual.point_time_unit) ignored("--point-time-unit", why);
    if (options.point_time_reference != usual.point_time_reference) ignored("--point-time-reference", why);
  }
  return warnings;
}

// Of fields that may hold the times which are looked for and were not found.
std::vector<std::string> unused_times(const SourceOptions& options, const SourceInfo& info) {
  if (options.point_times != PointTimes::kAuto || info.has_point_times) return {};
  std::vector<std::string> warnings;
  for (const FieldInfo& field : info.fields) {
    if (!field.may_hold_times) continue;
    warnings.push_back("field " + in_quotes(field.name) + " is not used; if it holds the points' times: --time-field " +
                       field.name);
  }
  return warnings;
}

class WithWarnings final : public WrappedSource {
 public:
  WithWarnings(std::unique_ptr<ScanSource> inner, std::vector<std::string> warnings)
      : WrappedSource(std::move(inner)), warnings_(std::move(warnings)) {}

  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.warnings.insert(info.warnings.begin(), warnings_.begin(), warnings_.end());
    return info;
  }

 private:
  std::vector<std::string> warnings_;
};

std::unique_ptr<ScanSource> with_warnings(std::unique_ptr<ScanSource> inner, std::vector<std::string> warnings) {
  if (warnings.empty()) return inner;
  return std::make_unique<WithWarnings>(std::move(inner), std::move(warnings));
}

}  // namespace

std::unique_ptr<ScanSource> with_field_warnings(std::unique_ptr<ScanSource> inner, const SourceOptions& options) {
  std::vector<std::string> warnings = unused_times(options, inner->info());
  return with_warnings(std::move(inner), std::move(warnings));
}

std::unique_ptr<ScanSource> with_option_warnings(std::unique_ptr<ScanSource> inner, const SourceOptions& options) {
  const SourceInfo info = inner->info();
  std::vector<std::string> warnings = unused_options(options, info);
  for (std::string& warning : unused_times(options, info)) warnings.push_back(std::move(warning));
  return with_warnings(std::move(inner), std::move(warnings));
}

}  // namespace rilo::detail
