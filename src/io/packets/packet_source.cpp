#include "io/packets/packet_source.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "io/packets/ouster.hpp"
#include "io/packets/velodyne.hpp"
#include "io/scan_listing.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kDatagramsLookedAt = 2000;  // datagrams

// What the first datagrams are.
struct Contents {
  std::map<std::pair<std::uint16_t, std::size_t>, std::size_t> counts;  // port, size → how many
  std::string velodyne;                                                 // one of its packets

  std::string text() const {
    std::string all;
    for (const auto& [kind, count] : counts) {
      all += (all.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(kind.second) +
             " bytes to port " + std::to_string(kind.first);
    }
    return all.empty() ? "no UDP datagrams" : "UDP datagrams: " + all;
  }
};

Contents contents_of(const fs::path& file) {
  UdpReader reader(file);
  Contents contents;
  for (std::size_t i = 0; i < kDatagramsLookedAt; ++i) {
    const auto datagram = reader.next();
    if (!datagram) break;
    if (contents.counts.size() < 8) ++contents.counts[{datagram->port, datagram->payload.size()}];
    const std::string_view flag = datagram->payload.substr(0, 2);
    const bool velodyne = datagram->payload.size() == kVelodynePacket && (flag == "\xFF\xEE" || flag == "\xFF\xDD");
    if (velodyne && contents.velodyne.empty()) contents.velodyne = std::string(datagram->payload);
  }
  return contents;
}

// As told, or of the same name as the recording, or the only JSON beside it.
fs::path find_metadata(const fs::path& file, const SourceOptions& options, const Contents& contents) {
  if (!options.sensor_file.empty()) return options.sensor_file;
  std::error_code error;
  fs::path twin = fs::path(file).replace_extension(".json");
  if (fs::exists(twin, error)) return twin;
  std::vector<fs::path> found;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (lower_case(entry->path().extension().string()) == ".json") found.push_back(entry->path());
  }
  if (found.size() == 1) return found[0];
  throw IoError({file, "", contents.text() + ", and " + std::to_string(found.size()) + " .json beside it",
                 "packets of a Velodyne (1206 bytes), or of an Ouster with its metadata beside it",
                 "Name the Ouster's metadata with --sensor-file; check that the right interface was recorded"});
}

std::unique_ptr<PacketDecoder> find_decoder(const fs::path& file, const SourceOptions& options) {
  const Contents contents = contents_of(file);
  if (!contents.velodyne.empty()) {
    return velodyne_decoder(velodyne_model(contents.velodyne, file, options.sensor_file));
  }
  const fs::path metadata_file = find_metadata(file, options, contents);
  OusterMetadata metadata = read_ouster_metadata(metadata_file);
  const std::size_t bytes = ouster_packet_bytes(metadata);
  const auto fits = [&](const auto& kind) { return kind.first.second == bytes; };
  if (std::none_of(contents.counts.begin(), contents.counts.end(), fits)) {
    throw IoError({file, "", contents.text(),
                   "packets of " + std::to_string(bytes) + " bytes, as " + metadata_file.string() + " says",
                   "Give the metadata of this very recording with --sensor-file"});
  }
  return ouster_decoder(std::move(metadata));
}

}  // namespace

PacketSource::PacketSource(const fs::path& file, const SourceOptions& options)
    : reader_(file), options_(options), decoder_(find_decoder(file, options)) {
  info_.kind = "packets";
  info_.path = file;
  info_.period_s = 1 / options.assumed_rate_hz;
  find_period();
}

// From the first turns, which stay in the queue.
void PacketSource::find_period() {
  constexpr std::size_t kTurns = 4;
  while (!ended_ && ready_.size() < kTurns) fill();
  std::vector<std::int64_t> stamps;
  for (const DecodedSweep& done : ready_) stamps.push_back(done.sweep.stamp_ns);
  // The first stamp is not that of a whole turn.
  if (stamps.size() > 2) stamps.erase(stamps.begin());
  if (const auto gap = median_gap_s(stamps)) info_.period_s = *gap;
}

// Takes datagrams until another sweep is done, or the recording ends.
void PacketSource::fill() {
  const std::size_t before = ready_.size();
  while (!ended_ && ready_.size() == before) {
    if (const auto datagram = reader_.next()) {
      if (decoder_->accepts(datagram->payload)) decoder_->take(datagram->payload, datagram->received_ns, ready_);
    } else {
      ended_ = true;
      decoder_->finish(ready_);
    }
  }
}

std::optional<Sweep> PacketSource::next() {
  while (true) {
    // One more than the next: only then is it known whether that is the last.
    while (!ended_ && ready_.size() < 2) fill();
    if (ready_.empty()) {
      refuse_shortened();
      return std::nullopt;
    }
    DecodedSweep done = std::move(ready_.front());
    ready_.pop_front();
    const bool first = !std::exchange(started_, true);
    const bool last = ended_ && ready_.empty();
    const bool alone = first && last;
    if (!done.whole && (first || last) && !alone) {
      ++left_out_;
      continue;
    }
    ++given_;
    set_times(done.sweep);
    return std::move(done.sweep);
  }
}

// After the sweeps that are whole, and once. To leave it out is to be content with these.
void PacketSource::refuse_shortened() {
  if (!reader_.shortened() || std::exchange(refused_, true) || options_.on_bad_sweep == OnBadSweep::kSkip) return;
  throw IoError({reader_.file(), "after sweep " + std::to_string(given_), "the file has become shorter",
                 "a file that stays as it is while it is read", "Check the disk, and that nobody writes the file"});
}

std::size_t PacketSource::skip(std::size_t count) {
  std::size_t skipped = 0;
  while (skipped < count && next()) ++skipped;
  return skipped;
}

void PacketSource::set_times(Sweep& sweep) const {
  if (options_.point_times == PointTimes::kNone) sweep.times_s.clear();
  if (options_.point_times == PointTimes::kAzimuth) {
    sweep.times_s = azimuth_times(sweep.points, info_.period_s, options_.spin_direction);
  }
}

std::string PacketSource::current_name() const { return reader_.file().string() + ", sweep " + std::to_string(given_); }

SourceInfo PacketSource::info() const {
  SourceInfo info = info_;
  info.format = decoder_->description();
  info.has_point_times = options_.point_times != PointTimes::kNone;
  info.point_times = decoder_->point_times();
  if (options_.point_times == PointTimes::kNone) info.point_times = "none";
  if (options_.point_times == PointTimes::kAzimuth) info.point_times = "azimuth";
  for (std::string& warning : reader_.warnings()) info.warnings.push_back(std::move(warning));
  if (left_out_ > 0) {
    info.warnings.push_back("left out: " + std::to_string(left_out_) +
                            " parts of a turn at the beginning and the end of the recording");
  }
  if (decoder_->clock_resets() > 0) {
    info.warnings.push_back("the sensor's clock was set " + std::to_string(decoder_->clock_resets()) +
                            " times: the stamps follow the recorder's");
  }
  return info;
}

}  // namespace rilo::detail
