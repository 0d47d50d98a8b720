#include "io/packets/packet_source.hpp"

#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "io/bad_sweeps.hpp"
#include "io/packets/captures.hpp"
#include "io/packets/find_decoder.hpp"
#include "io/packets/one_sensor.hpp"
#include "io/packets/udp_reader.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "io/times/sweep_period.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::detail {
namespace {

class PacketSource final : public ScanSource {
 public:
  PacketSource(const std::filesystem::path& path, const std::string& topic, std::unique_ptr<PacketStream> stream,
               std::unique_ptr<PacketDecoder> decoder, const SourceOptions& options)
      : stream_(std::move(stream)), options_(options), decoder_(std::move(decoder)) {
    info_.kind = "packets";
    info_.path = path;
    info_.topic = topic;
    info_.period_s = 1 / options.assumed_rate_hz();
    find_period();
  }

  std::optional<Sweep> next() override {
    while (true) {
      // One more than the next: only then is it known whether that is the last.
      while (!ended_ && !error_ && ready_.size() < 2) fill();
      if (ready_.empty()) {
        if (error_) throw IoError(*std::exchange(error_, std::nullopt));
        reject_shortened();
        return std::nullopt;
      }
      DecodedSweep done = std::move(ready_.front());
      ready_.pop_front();
      const bool first = !std::exchange(started_, true);
      const bool last = ended_ && ready_.empty();
      const bool alone = first && last;
      if (!done.whole && (first || last) && !alone) {
        ++incomplete_;
        continue;
      }
      ++given_;
      set_times(done.sweep);
      return std::move(done.sweep);
    }
  }

  std::size_t skip(std::size_t count) override {
    std::size_t skipped = 0;
    while (skipped < count) {
      try {
        if (!next()) break;
        ++skipped;
      } catch (const IoError&) {
        if (rejected_) throw;  // a damaged message among those skipped does not matter
      }
    }
    return skipped;
  }

  std::optional<std::size_t> size() const override { return std::nullopt; }
  std::size_t current_index() const override { return given_ == 0 ? 0 : given_ - 1; }

  std::string current_name() const override {
    return info_.path.string() + ", sweep " + std::to_string(given_) +
           (info_.topic.empty() ? "" : " of " + info_.topic);
  }

  SourceInfo info() const override {
    SourceInfo info = info_;
    const std::string container = stream_->format();
    info.format = container + (container.empty() ? "" : ", ") + decoder_->description();
    info.frame_id = stream_->frame_id();
    info.has_point_times = options_.point_times != PointTimes::kNone;
    info.point_times = "of the packets, s since the earliest point";
    if (options_.point_times == PointTimes::kNone) info.point_times = "none";
    if (options_.point_times == PointTimes::kAzimuth) info.point_times = "azimuth";
    for (std::string& warning : stream_->warnings()) info.warnings.push_back(std::move(warning));
    for (std::string& warning : decoder_->warnings()) info.warnings.push_back(std::move(warning));
    if (ended_ && ready_.empty()) add_counts(info);
    return info;
  }

 private:
  // From the first revolutions, which stay in the queue.
  void find_period() {
    constexpr std::size_t kRevolutions = 4;
    while (!ended_ && !error_ && ready_.size() < kRevolutions) fill();
    std::vector<std::int64_t> stamps;
    for (const DecodedSweep& done : ready_) stamps.push_back(done.sweep.stamp_ns);
    // The first stamp is not that of a whole revolution.
    if (stamps.size() > 2) stamps.erase(stamps.begin());
    if (const auto period_s = mean_period_s(stamps)) info_.period_s = *period_s;
  }

  // Takes packets until another sweep is done, a message cannot be read, or the recording ends.
  void fill() {
    const std::size_t before = ready_.size();
    while (!ended_ && !error_ && ready_.size() == before) {
      try {
        if (const auto datagram = stream_->next()) {
          take(*datagram);
        } else {
          ended_ = true;
          decoder_->finish(ready_);
        }
      } catch (const IoError& error) {
        if (options_.on_bad_sweep == OnBadSweep::kFail) {
          error_ = error;
        } else {
          note_bad_sweep(error, info_);
        }
      }
    }
  }

  void take(const Datagram& datagram) {
    if (decoder_->accepts(datagram.payload)) {
      if (sensor_.takes(datagram)) decoder_->take(datagram.payload, datagram.received_ns, ready_);
    } else if (decoder_->is_of_another(datagram.payload)) {
      sensor_.leave_out(datagram);
    } else if (!stream_->is_mixed()) {
      ++unusable_;
    }
  }

  // After the sweeps that are whole, and once. To skip it is to be content with these.
  void reject_shortened() {
    if (!stream_->shortened() || std::exchange(rejected_, true) || options_.on_bad_sweep == OnBadSweep::kSkip) return;
    throw IoError({info_.path, "after sweep " + std::to_string(given_), "the file has become shorter",
                   "a file that stays as it is while it is read",
                   "Check the disk, and that no other program writes the file"});
  }

  // When the sensor faced forward, by the packets' own times.
  static double forward_s(const Sweep& sweep) {
    double forward_s = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
      const Eigen::Vector3d p = sweep.points[i].cast<double>();
      const double off = std::abs(std::atan2(p.y(), p.x()));  // NaN: never the least
      if (off < least) {
        least = off;
        forward_s = static_cast<double>(sweep.times_s[i]);
      }
    }
    return forward_s;
  }

  void set_times(Sweep& sweep) const {
    if (options_.point_times == PointTimes::kNone) sweep.times_s.clear();
    if (options_.point_times == PointTimes::kAzimuth) {
      sweep.stamp_ns += nanoseconds(forward_s(sweep));
      sweep.times_s = azimuth_times(sweep.points, info_.period_s, options_.spin_direction);
    }
  }

  // Once, at the end: counts that grow would be new warnings all the time.
  void add_counts(SourceInfo& info) const {
    if (incomplete_ > 0) {
      info.warnings.push_back("dropped " + counted(incomplete_, "incomplete revolution") +
                              " at the ends of the recording");
    }
    if (unusable_ > 0) {
      info.warnings.push_back("dropped " + counted(unusable_, "packet") + " of another size or kind than the LiDAR's");
    }
    for (std::string& warning : sensor_.warnings()) info.warnings.push_back(std::move(warning));
    if (decoder_->dropped_packets() > 0) {
      info.warnings.push_back("dropped " + counted(decoder_->dropped_packets(), "packet") +
                              " that came twice or too late for their sweep");
    }
    if (info.bad_sweeps > 0) {
      info.warnings.push_back("dropped " + counted(info.bad_sweeps, "message") + " that could not be read");
    }
    if (decoder_->clock_resets() > 0) {
      info.warnings.push_back("the sensor's clock was set " + counted(decoder_->clock_resets(), "time") +
                              ": the stamps follow the recorder's");
    }
  }

  std::unique_ptr<PacketStream> stream_;
  SourceOptions options_;
  std::unique_ptr<PacketDecoder> decoder_;
  OneSensor sensor_;
  SourceInfo info_;
  std::deque<DecodedSweep> ready_;
  std::optional<IoError> error_;  // of a message behind the sweeps that are ready
  std::size_t given_ = 0;
  std::size_t incomplete_ = 0;  // revolutions at the beginning and the end
  std::size_t unusable_ = 0;    // packets that are not the LiDAR's
  bool started_ = false;
  bool rejected_ = false;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<ScanSource> packet_source(const std::filesystem::path& path, const std::string& topic,
                                          std::unique_ptr<PacketStream> stream, std::unique_ptr<PacketDecoder> decoder,
                                          const SourceOptions& options) {
  return std::make_unique<PacketSource>(path, topic, std::move(stream), std::move(decoder), options);
}

std::unique_ptr<ScanSource> open_captures(const std::filesystem::path& path,
                                          const std::vector<std::filesystem::path>& files,
                                          const SourceOptions& options) {
  const auto open = [&]() -> std::unique_ptr<PacketStream> {
    if (files.size() == 1) return std::make_unique<UdpReader>(files[0]);
    return in_turn(files);
  };
  auto decoder = find_decoder(*open(), files[0], options);
  return packet_source(path, "", open(), std::move(decoder), options);
}

}  // namespace rilo::detail
