#include "io/file_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/bin_fields.hpp"
#include "io/cloud_columns.hpp"
#include "io/file_bytes.hpp"
#include "io/pcd_header.hpp"
#include "io/ply_header.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo::detail {
namespace {

PointTimeHints hints_of(const ScanListing& listing, const SourceOptions& options) {
  PointTimeHints hints{options.point_time_unit, options.point_time_reference, std::nullopt, listing.info.period_s};
  if (listing.period_known) hints.period_s = listing.info.period_s;
  if (!listing.fraction_files.empty()) hints.unit = PointTimeUnit::kFraction;
  return hints;
}

std::vector<Field> fields_of(const std::filesystem::path& file, const std::string& format,
                             const SourceOptions& options) {
  constexpr std::size_t kLongestHeader = std::size_t{1} << 16;
  if (format == "bin") return parse_bin_fields(options.bin_fields);
  const FileBytes start = read_file(file, kLongestHeader);
  if (format == "pcd") return parse_pcd_header(file, start.view()).fields;
  std::vector<Field> fields;
  for (const PlyElement& element : parse_ply_header(file, start.view()).elements) {
    if (element.name != "vertex") continue;
    for (const PlyProperty& property : element.properties) fields.push_back({property.name, property.type, 1});
  }
  return fields;
}

// What the first file promises. A file that cannot be read is reported when its turn comes.
std::optional<std::string> promised_times(const ScanListing& listing, const SourceOptions& options) {
  if (!listing.fraction_files.empty()) return "times_pt, fractions of the sweep since its stamp";
  try {
    const std::vector<Field> fields = fields_of(listing.files.front(), listing.info.format, options);
    const FieldRoles roles = find_roles(fields, options.time_field, listing.files.front());
    if (roles.time) return "field " + fields[*roles.time].name;
  } catch (const IoError&) {
    return std::nullopt;
  }
  return std::nullopt;
}

std::string describe_azimuth(const SourceOptions& options, double period_s) {
  return "azimuth, " + std::string(to_string(options.spin_direction)) + ", period " + std::to_string(period_s) + " s";
}

RawTimes read_fractions(const std::filesystem::path& file, std::size_t points) {
  const FileBytes bytes = read_file(file);
  if (bytes.size != points * sizeof(float)) {
    throw IoError({file, "", std::to_string(bytes.size) + " bytes",
                   std::to_string(points) + " float32, one for each point of the sweep",
                   "Copy or write the drive again, or set point_times to none or azimuth"});
  }
  RawTimes times{"times_pt", ScalarType::kFloat32, {}, {}};
  times.floats.resize(points);
  const ColumnView column{bytes.data.get(), sizeof(float), ScalarType::kFloat32, false};
  read_column(column, times.floats);
  return times;
}

}  // namespace

FileSource::FileSource(ScanListing listing, const SourceOptions& options)
    : listing_(std::move(listing)), options_(options), times_(hints_of(listing_, options)) {
  SourceInfo& info = listing_.info;
  if (options.point_times == PointTimes::kAzimuth) {
    info.has_point_times = true;
    info.point_times = describe_azimuth(options, info.period_s);
  } else if (options.point_times == PointTimes::kAuto) {
    const auto promised = promised_times(listing_, options);
    info.has_point_times = promised.has_value();
    info.point_times = promised.value_or("none");
  }
}

std::optional<Sweep> FileSource::next() {
  while (cursor_ < listing_.files.size()) {
    current_ = cursor_++;
    try {
      return load(current_);
    } catch (const IoError& error) {
      if (options_.on_bad_sweep == OnBadSweep::kFail) throw;
      note_bad(error);
    }
  }
  return std::nullopt;
}

std::size_t FileSource::skip(std::size_t count) {
  const std::size_t skipped = std::min(count, listing_.files.size() - cursor_);
  cursor_ += skipped;
  return skipped;
}

std::string FileSource::current_name() const { return listing_.files[current_].string(); }

SourceInfo FileSource::info() const {
  SourceInfo info = listing_.info;
  const auto& convention = times_.convention();
  const bool stamped_by_points = convention && convention->reference == PointTimeReference::kEpoch;
  if (stamped_by_points) info.stamps_assumed = false;
  if (info.stamps_assumed && info.kind != "file") {
    info.warnings.insert(info.warnings.begin(),
                         "no stamps in the data: " + std::to_string(std::lround(options_.assumed_rate_hz)) +
                             " sweeps a second are assumed");
  }
  if (info.bad_sweeps > 0) {
    info.warnings.push_back(std::to_string(info.bad_sweeps) + " sweeps could not be read and were left out");
  }
  return info;
}

RawCloud FileSource::read_cloud(const std::filesystem::path& file) const {
  if (listing_.info.format == "bin") return read_bin(file, options_.bin_fields);
  if (listing_.info.format == "pcd") return read_pcd(file, options_.time_field);
  return read_ply(file, options_.time_field);
}

Sweep FileSource::load(std::size_t index) {
  RawCloud cloud = read_cloud(listing_.files[index]);
  Sweep sweep;
  sweep.stamp_ns = listing_.stamps_ns[index];
  sweep.points = std::move(cloud.points);
  sweep.intensities = std::move(cloud.intensities);
  sweep.rings = std::move(cloud.rings);
  set_times(index, std::move(cloud.times), sweep);
  return sweep;
}

void FileSource::set_times(std::size_t index, std::optional<RawTimes> times, Sweep& sweep) {
  SourceInfo& info = listing_.info;
  if (options_.point_times == PointTimes::kNone) return;
  if (options_.point_times == PointTimes::kAzimuth) {
    sweep.stamp_ns += std::llround(listing_.forward_after_s * 1e9);
    sweep.times_s = azimuth_times(sweep.points, info.period_s, options_.spin_direction);
    return;
  }
  std::filesystem::path file = listing_.files[index];
  if (!listing_.fraction_files.empty()) {
    file = listing_.fraction_files[index];
    times = read_fractions(file, sweep.points.size());
  }
  info.has_point_times = times.has_value();
  if (!times) {
    info.point_times = "none";
    return;
  }
  times_.decode(*times, file, sweep);
  if (!times_.description().empty()) info.point_times = times_.description();
}

void FileSource::note_bad(const IoError& error) {
  constexpr std::size_t kMostMessages = 20;
  if (listing_.info.bad_sweeps++ < kMostMessages) {
    listing_.info.warnings.push_back(std::string("left out: ") + error.what());
  }
}

}  // namespace rilo::detail
