#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "io/bin_fields.hpp"
#include "io/file_source.hpp"
#include "io/scan_listing.hpp"
#include "rilo/io/elevation_correction.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/prefetch_source.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo {
namespace fs = std::filesystem;
namespace {

void check_options(const SourceOptions& options) {
  constexpr double kLargestRate = 1000;
  detail::parse_bin_fields(options.bin_fields);
  if (!(options.assumed_rate_hz > 0 && options.assumed_rate_hz <= kLargestRate)) {
    throw std::invalid_argument("assumed_rate_hz is " + std::to_string(options.assumed_rate_hz) +
                                "; it must be above 0 and at most 1000");
  }
}

detail::ScanListing list_data(const fs::path& path, const SourceOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    const bool is_sequence = fs::is_directory(path / "velodyne", error);
    return is_sequence ? detail::list_sequence(path, options) : detail::list_plain_folder(path, options);
  }
  if (fs::is_regular_file(status)) return detail::list_single_file(path, options);
  throw IoError({path, "", fs::exists(status) ? "neither a folder nor a file" : "there is nothing of this name",
                 "a KITTI sequence folder, a folder of .bin, .pcd or .ply sweeps, or one such file", "Check the path"});
}

}  // namespace

std::unique_ptr<ScanSource> open_scan_source(const fs::path& path, const SourceOptions& options) {
  check_options(options);
  std::unique_ptr<ScanSource> source = std::make_unique<detail::FileSource>(list_data(path, options), options);
  if (options.elevation_correction_deg != 0) {
    source = with_elevation_correction(std::move(source), options.elevation_correction_deg);
  }
  if (options.read_ahead > 0) source = std::make_unique<PrefetchSource>(std::move(source), options.read_ahead);
  return source;
}

}  // namespace rilo
