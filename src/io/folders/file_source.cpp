// Sweeps from files, one file each.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/bad_sweeps.hpp"
#include "io/clouds/cloud_columns.hpp"
#include "io/clouds/pcd_header.hpp"
#include "io/clouds/ply_header.hpp"
#include "io/file_bytes.hpp"
#include "io/folders/scan_listing.hpp"
#include "io/text.hpp"
#include "io/times/sweep_timing.hpp"
#include "io/times/time_field.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo::detail {
namespace {

PointTimeHints hints_of(const ScanListing& listing, const SourceOptions& options) {
  PointTimeHints hints{options.point_time_unit, options.point_time_reference, std::nullopt, listing.info.period_s};
  if (listing.period_known) hints.period_s = listing.info.period_s;
  if (!listing.fraction_files.empty() || listing.column_points > 0) hints.unit = PointTimeUnit::kFraction;
  return hints;
}

SourceOptions with_bin_fields(const ScanListing& listing, SourceOptions options) {
  if (options.bin_fields == "auto" && listing.info.format == "bin")
    options.bin_fields = guess_bin_fields(listing.files);
  return options;
}

std::vector<Field> fields_of(const std::filesystem::path& file, const std::string& format,
                             const SourceOptions& options) {
  constexpr std::size_t kLongestHeader = std::size_t{1} << 16;
  if (format == "bin") return parse_bin_fields(options.bin_fields);
  const FileBytes start = read_file(file, kLongestHeader);
  if (format == "pcd") return parse_pcd_header(file, start.view()).fields;
  for (const PlyElement& element : parse_ply_header(file, start.view()).elements) {
    if (element.name == "vertex") return element.fields();
  }
  return {};
}

// Of the first sweeps, before the first is given.
constexpr std::size_t kLookedAt = 12;

// What the first file that can be read has, its time field above all; also fills in the fields of the listing. A file
// that cannot be read is reported when it is reached.
std::optional<std::string> promised_field(ScanListing& listing, const SourceOptions& options) {
  for (std::size_t i = 0; i < std::min(kLookedAt, listing.files.size()); ++i) {
    try {
      const std::vector<Field> fields = fields_of(listing.files[i], listing.info.format, options);
      const FieldRoles roles = find_roles(fields, options.time_field, {listing.files[i]});
      listing.info.fields = describe_fields(fields, roles);
      if (!roles.time) return std::nullopt;
      return "field " + fields[*roles.time].name;
    } catch (const IoError&) {
      continue;
    }
  }
  return std::nullopt;
}

std::optional<std::string> promised_times(ScanListing& listing, const SourceOptions& options) {
  auto field = promised_field(listing, options);
  if (listing.column_points > 0) return "the order of the points, fractions of the sweep since its stamp";
  if (!listing.fraction_files.empty()) return "times_pt, fractions of the sweep since its stamp";
  return field;
}

// Of a sensor whose columns lie one after the other; a sweep that lacks points has none.
std::optional<RawTimes> column_fractions(std::size_t points, std::size_t column_points) {
  constexpr std::size_t kColumns = 1024;
  if (points != column_points * kColumns) return std::nullopt;
  RawTimes times{"order of the points", ScalarType::kFloat32, {}, {}};
  times.floats.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t column = i / column_points;
    times.floats[i] = static_cast<double>(column) / static_cast<double>(kColumns);
  }
  return times;
}

RawTimes read_fractions(const std::filesystem::path& file, std::size_t points) {
  const FileBytes bytes = read_file(file);
  if (bytes.size != points * sizeof(float)) {
    throw IoError({file, "", counted(bytes.size, "byte"),
                   std::to_string(points) + " float32, one for each point of the sweep",
                   "Copy or write the drive again, or set point_times (--point-times) to none or azimuth"});
  }
  RawTimes times{"times_pt", ScalarType::kFloat32, {}, {}};
  times.floats.resize(points);
  const ColumnView column{bytes.data.get(), sizeof(float), ScalarType::kFloat32, false};
  read_column(column, times.floats);
  return times;
}

// The ends of the times of some sweeps, and the stamps that the sweeps have without them.
struct FirstTimes {
  std::vector<RawTimes> ends;
  std::vector<std::int64_t> stamps_ns;
};

class FileSource final : public ScanSource {
 public:
  FileSource(ScanListing listing, const SourceOptions& options)
      : listing_(std::move(listing)),
        options_(with_bin_fields(listing_, options)),
        timing_(options, hints_of(listing_, options), listing_.info.period_s, listing_.info.stamps_assumed) {
    if (options.bin_fields != "auto") doubt_bin_fields();
    const auto promised = promised_times(listing_, options_);
    if (!timing_.reads_times()) return;
    const FirstTimes first = promised ? first_times() : FirstTimes{};
    timing_.promise(promised, first.ends, first.stamps_ns);
    const auto& shown = timing_.shown_period();
    if (!listing_.info.stamps_assumed || options_.rate_hz || !shown) return;
    if (shown->by_stamps) {
      listing_.info.period_s = shown->s;
    } else {
      assume_stamps(listing_, sweep_length_s(shown->s));
    }
  }

  std::optional<Sweep> next() override {
    while (cursor_ < listing_.files.size()) {
      current_ = cursor_++;
      try {
        return load(current_);
      } catch (const IoError& error) {
        if (options_.on_bad_sweep == OnBadSweep::kFail) throw;
        note_bad_sweep(error, listing_.info);
      }
    }
    return std::nullopt;
  }

  std::size_t skip(std::size_t count) override {
    const std::size_t skipped = std::min(count, listing_.files.size() - cursor_);
    cursor_ += skipped;
    return skipped;
  }

  std::optional<std::size_t> size() const override { return listing_.files.size(); }
  std::size_t current_index() const override { return current_; }
  std::string current_name() const override { return listing_.files[current_].string(); }

  SourceInfo info() const override {
    SourceInfo info = listing_.info;
    info.has_point_times = timing_.has_times();
    info.point_times = timing_.description();
    if (timing_.sets_stamps()) info.stamps_assumed = false;
    if (info.stamps_assumed && info.kind != "file") {
      const auto& shown = timing_.shown_period();
      const bool lasts = shown && !shown->by_stamps && !options_.rate_hz;
      const std::string why = lasts ? fmt::format(", since a sweep lasts {:.3g} s", info.period_s) : "";
      info.warnings.insert(
          info.warnings.begin(),
          fmt::format("no timestamps found; assuming {:.3g} Hz{} (change with --rate)", 1 / info.period_s, why));
    }
    for (std::string& warning : timing_.warnings()) info.warnings.push_back(std::move(warning));
    add_bad_sweep_count(info);
    return info;
  }

 private:
  RawCloud read_cloud(const std::filesystem::path& file) const {
    if (listing_.info.format == "bin") return read_bin(file, options_.bin_fields);
    if (listing_.info.format == "pcd") return read_pcd(file, options_.time_field);
    return read_ply(file, options_.time_field);
  }

  // A wrong number of columns may fit the sizes by chance.
  void doubt_bin_fields() {
    if (listing_.info.format != "bin" || listing_.files.empty()) return;
    const std::filesystem::path& middle = listing_.files[listing_.files.size() / 2];
    const std::string doubt = doubt_about_columns(middle, parse_bin_fields(options_.bin_fields).size());
    if (!doubt.empty()) listing_.info.warnings.push_back(middle.string() + ": " + doubt);
  }

  // Of the first three sweeps with times that differ: the steps between these say whether they count from an epoch.
  FirstTimes first_times() const {
    constexpr std::size_t kWanted = 3;
    FirstTimes first;
    if (!listing_.fraction_files.empty() || listing_.column_points > 0) return first;  // known
    std::size_t telling = 0;
    for (std::size_t i = 0; i < std::min(kLookedAt, listing_.files.size()) && telling < kWanted; ++i) {
      try {
        const RawCloud cloud = read_cloud(listing_.files[i]);
        if (cloud.times && add_time_ends(*cloud.times, cloud.points, first.ends)) ++telling;
        first.stamps_ns.resize(first.ends.size(), listing_.stamps_ns[i]);
      } catch (const IoError&) {
        // Reported when it is reached.
      }
    }
    return first;
  }

  // All points of a sweep span a little more than the bulk of them, which shows the period; single ones may be far off.
  double sweep_length_s(double bulk_s) {
    constexpr double kMostMore = 1.15;
    const SweepTiming as_before = timing_;
    double length_s = bulk_s;
    try {
      const Sweep sweep = load(0);
      const auto [first, last] = std::minmax_element(sweep.times_s.begin(), sweep.times_s.end());
      if (first != last) length_s = std::clamp(static_cast<double>(*last - *first), bulk_s, kMostMore * bulk_s);
    } catch (const IoError&) {
      // Reported when it is reached.
    }
    timing_ = as_before;
    return length_s;
  }

  Sweep load(std::size_t index) {
    RawCloud cloud = read_cloud(listing_.files[index]);
    Sweep sweep;
    sweep.stamp_ns = listing_.stamps_ns[index];
    sweep.points = std::move(cloud.points);
    sweep.intensities = std::move(cloud.intensities);
    sweep.rings = std::move(cloud.rings);
    set_times(index, std::move(cloud.times), sweep);
    return sweep;
  }

  void set_times(std::size_t index, std::optional<RawTimes> times, Sweep& sweep) {
    std::filesystem::path file = listing_.files[index];
    if (options_.point_times == PointTimes::kAuto && !listing_.fraction_files.empty()) {
      file = listing_.fraction_files[index];
      times = read_fractions(file, sweep.points.size());
    }
    if (!times && listing_.column_points > 0) times = column_fractions(sweep.points.size(), listing_.column_points);
    timing_.apply(times, file, listing_.forward_after_s, sweep);
  }

  ScanListing listing_;
  SourceOptions options_;
  SweepTiming timing_;
  std::size_t cursor_ = 0;   // of the next sweep
  std::size_t current_ = 0;  // of the last one
};

}  // namespace

std::unique_ptr<ScanSource> open_files(ScanListing listing, const SourceOptions& options) {
  return std::make_unique<FileSource>(std::move(listing), options);
}

}  // namespace rilo::detail
