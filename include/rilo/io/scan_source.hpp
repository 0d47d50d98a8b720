// Sweeps, one after the other, from any source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rilo/cloud/sweep.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/io/source_options.hpp"

namespace rilo {

class LiveQueue;

/// What is wrong with the stamps of the sweeps given so far. None of it stops a run.
struct StampFaults {
  std::size_t gaps = 0;          ///< steps of more than 1.5 periods
  std::size_t missing = 0;       ///< sweeps that would have been in them
  double longest_gap_s = 0;      ///< 0: none
  std::size_t duplicates = 0;    ///< dropped: the same stamp and the same points as the one before
  std::size_t out_of_order = 0;  ///< dropped: older than a sweep before, by a second at most
  std::size_t repeated = 0;      ///< kept: the stamp of the one before, other points
  std::size_t clock_jumps = 0;   ///< kept: older by more, or the sixth older one in a row: the clock was set back
  std::size_t late = 0;          ///< kept: recorded more than a period later than the promptest one, see its stamp
  double most_late_s = 0;        ///< of those

  friend bool operator==(const StampFaults&, const StampFaults&) = default;
};

/// A field of the points, as the data name it.
struct FieldInfo {
  std::string name;
  bool used = false;
  bool may_hold_times = false;  ///< not used, but called like one, see SourceOptions::time_field
};

/// What a source is and what was decided about it. Some of it is known only after the first sweep was read.
struct SourceInfo {
  std::string kind;            ///< "kitti", "drive simulator", "folder", "file", "recording", "packets", …
  std::string format;          ///< "bin", "pcd", "ply", "mcap", "ROS 1 bag", …
  std::filesystem::path path;  ///< as given
  std::optional<std::size_t> sweeps;
  double period_s = 0.1;                ///< mean step of the stamps without gaps, or 1 / the rate assumed
  bool stamps_assumed = false;          ///< the data has no stamps
  bool has_point_times = false;         ///< sweeps come with per-point times
  std::string point_times = "none";     ///< where they come from, with unit and reference
  std::vector<FieldInfo> fields;        ///< of the first sweep; empty where fields have no names (packets)
  double elevation_correction_deg = 0;  ///< applied; 0: none
  std::optional<SE3> T_cam_lidar;       ///< KITTI's `Tr`
  std::string topic;                    ///< of a recording
  std::string frame_id;                 ///< of its messages
  StampFaults faults;                   ///< of the stamps so far
  std::size_t parts = 1;                ///< of the data that are joined to a sweep, see SourceOptions::parts
  std::size_t bad_sweeps = 0;           ///< skipped so far (OnBadSweep::kSkip)
  /// Sweeps from this place on have another place than ScanSource::current_index() says: damage took an unknown number
  /// of sweeps before them. Nothing: all places are known.
  std::optional<std::size_t> places_known;
  std::vector<std::string> warnings;  ///< sentences for the user
};

/// A topic of a recording.
struct TopicInfo {
  std::string name;
  std::string type;                       ///< "sensor_msgs/PointCloud2", "sensor_msgs/msg/PointCloud2", …
  std::optional<std::uint64_t> messages;  ///< when known without reading them
  bool scans = false;                     ///< one of those that SourceOptions::topic chooses from
  std::string frame_id;                   ///< of the first message of a topic with scans; empty where it has none
};

/// A stream of sweeps. Not thread-safe. Memory does not grow with the data.
class ScanSource {
 public:
  virtual ~ScanSource() = default;

  /// The next sweep, or nothing at the end.
  /// @throws IoError when it cannot be read; the following call continues with the sweep after it.
  virtual std::optional<Sweep> next() = 0;

  /// Skips up to `count` sweeps without reading them; returns how many there were. Cheapest before the first
  /// next().
  virtual std::size_t skip(std::size_t count) = 0;

  /// Number of sweeps in all, when it is known without reading them.
  virtual std::optional<std::size_t> size() const = 0;

  /// Place in the data (from 0) of the sweep that next() gave last, of its first part where parts are joined: ground
  /// truth is looked up with it, since bad and skipped sweeps leave holes in the count.
  virtual std::size_t current_index() const = 0;

  /// Name of that sweep for messages: the path of its file.
  virtual std::string current_name() const = 0;

  virtual SourceInfo info() const = 0;

 protected:
  ScanSource() = default;
  ScanSource(const ScanSource&) = default;
  ScanSource& operator=(const ScanSource&) = default;
};

/// Opens a data set's folder (KITTI, MulRan, a drive simulator's), a folder of .bin, .pcd or .ply sweeps, one such
/// file, or a recording (bags, MCAP, packets); the kind is guessed from what lies in the path. Elevation correction and
/// reading ahead are in place as `options` say. See docs/file-formats.md.
/// @throws IoError when the path is none of these; std::invalid_argument when an option makes no sense.
std::unique_ptr<ScanSource> open_scan_source(const std::filesystem::path& path, const SourceOptions& options = {});

/// All topics of the recording (ROS 1 bags, rosbag2, MCAP) at `path`; empty for other data.
/// @throws IoError when the recording cannot be read.
std::vector<TopicInfo> recorded_topics(const std::filesystem::path& path);

/// PointCloud2 messages as they arrive: a source whose next() waits for the next message, and ends when the queue is
/// closed. Opening it waits for the messages of the looking ahead. The sweeps are those that a recording of the same
/// messages gives, to the last bit. Options that concern files are ignored; nothing is read ahead.
std::unique_ptr<ScanSource> open_live_source(std::shared_ptr<LiveQueue> queue, const SourceOptions& options = {});

}  // namespace rilo
