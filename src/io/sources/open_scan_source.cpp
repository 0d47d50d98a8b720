#include <stdexcept>
#include <system_error>
#include <utility>

#include "io/clouds/cloud_columns.hpp"
#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/folders/scan_listing.hpp"
#include "io/packets/captures.hpp"
#include "io/packets/packet_source.hpp"
#include "io/ros/recording_source.hpp"
#include "io/sources/source_wrappers.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/live_queue.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo {
namespace fs = std::filesystem;
namespace {

void check_options(const SourceOptions& options) {
  constexpr double kLargestRate = 1000;
  if (options.bin_fields != "auto") detail::parse_bin_fields(options.bin_fields);
  if (!(options.assumed_rate_hz() > 0 && options.assumed_rate_hz() <= kLargestRate)) {
    throw std::invalid_argument("rate_hz is " + std::to_string(options.assumed_rate_hz()) +
                                "; it must be above 0 and at most 1000");
  }
  if (options.parts < 0 || options.parts > SourceOptions::kMostParts) {
    throw std::invalid_argument("parts is " + std::to_string(options.parts) + "; it must be from 0 to " +
                                std::to_string(SourceOptions::kMostParts));
  }
  if (options.parts > 1 && options.point_times == PointTimes::kAzimuth) {
    throw std::invalid_argument(
        "parts are joined, and azimuth times are those of whole turns: leave out one of the two");
  }
}

std::string extension_of(const fs::path& file) { return detail::lower_case(file.extension().string()); }

std::unique_ptr<detail::Recording> recording_in_folder(const fs::path& folder) {
  if (detail::is_rosbag2(folder)) return detail::open_rosbag2(folder);
  auto bags = detail::files_with(folder, {".bag"});
  if (!bags.empty()) return detail::open_in_turn(std::move(bags), detail::open_bag);
  return nullptr;
}

std::unique_ptr<detail::Recording> recording_in_file(const fs::path& file) {
  if (detail::is_rosbag2(file)) return detail::open_rosbag2(file);
  if (extension_of(file) == ".bag") return detail::open_bag(file);
  return nullptr;
}

std::unique_ptr<ScanSource> open_folder(const fs::path& folder, const SourceOptions& options) {
  if (detail::sweep_folder(folder) == folder) {
    if (auto recording = recording_in_folder(folder)) {
      return detail::open_recording(folder, std::move(recording), options);
    }
    if (detail::files_with(folder, {".bin", ".pcd", ".ply"}).empty()) {
      if (const auto captures = detail::captures_in(folder); !captures.empty()) {
        return detail::open_captures(folder, captures, options);
      }
    }
  }
  return detail::open_files(detail::list_folder(folder, options), options);
}

std::unique_ptr<ScanSource> open_file(const fs::path& file, const SourceOptions& options) {
  if (detail::is_capture(file)) return detail::open_captures(file, {file}, options);
  if (auto recording = recording_in_file(file)) return detail::open_recording(file, std::move(recording), options);
  return detail::open_files(detail::list_single_file(file, options), options);
}

std::unique_ptr<detail::Recording> recording_at(const fs::path& path) {
  return detail::is_folder(path) ? recording_in_folder(path) : recording_in_file(path);
}

std::unique_ptr<ScanSource> open_data(const fs::path& path, const SourceOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return open_folder(path, options);
  if (fs::is_regular_file(status)) return open_file(path, options);
  throw IoError({path, "", fs::exists(status) ? "neither a folder nor a file" : "no such file or folder",
                 "a recording, a folder of sweeps, or one sweep", "Check the path"});
}

std::unique_ptr<ScanSource> in_order_and_corrected(std::unique_ptr<ScanSource> source, const SourceOptions& options) {
  source = detail::with_stamp_order(std::move(source));
  // Azimuth times are those of whole turns.
  if (options.point_times != PointTimes::kAzimuth) {
    source = detail::with_joined_parts(std::move(source), static_cast<std::size_t>(options.parts));
  }
  if (options.point_times == PointTimes::kOrder) source = detail::with_order_times(std::move(source));
  if (options.elevation_correction_deg == 0) return source;
  return detail::with_elevation_correction(std::move(source), options.elevation_correction_deg);
}

}  // namespace

std::unique_ptr<ScanSource> open_live_source(std::shared_ptr<LiveQueue> queue, const SourceOptions& options) {
  check_options(options);
  LiveQueue& live = *queue;  // the source keeps it
  auto source =
      in_order_and_corrected(detail::open_recording("live", detail::open_live(std::move(queue)), options), options);
  live.join(source->info().parts);
  return detail::with_field_warnings(std::move(source), options);
}

std::unique_ptr<ScanSource> open_scan_source(const fs::path& path, const SourceOptions& options) {
  check_options(options);
  std::unique_ptr<ScanSource> source = in_order_and_corrected(open_data(path, options), options);
  source = detail::with_option_warnings(std::move(source), options);
  return options.read_ahead == 0 ? std::move(source) : detail::with_read_ahead(std::move(source), options.read_ahead);
}

std::vector<TopicInfo> recorded_topics(const fs::path& path) {
  const auto recording = recording_at(path);
  return recording ? detail::describe_topics(*recording) : std::vector<TopicInfo>{};
}

}  // namespace rilo
