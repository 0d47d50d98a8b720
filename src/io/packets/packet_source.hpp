// Sweeps from the recorded packets of a sensor.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/packets/packet_decoder.hpp"
#include "io/packets/packet_stream.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

class PacketSource final : public ScanSource {
 public:
  /// `path`, as given, and `topic` (empty for a capture) are for info() and messages.
  PacketSource(const std::filesystem::path& path, const std::string& topic, std::unique_ptr<PacketStream> stream,
               std::unique_ptr<PacketDecoder> decoder, const SourceOptions& options);

  std::optional<Sweep> next() override;
  std::size_t skip(std::size_t count) override;
  std::optional<std::size_t> size() const override { return std::nullopt; }
  std::size_t current_index() const override { return given_ == 0 ? 0 : given_ - 1; }
  std::string current_name() const override;
  SourceInfo info() const override;

 private:
  void fill();
  void take(const Datagram& datagram);
  void reject_shortened();
  void add_counts(SourceInfo& info) const;
  void find_period();
  void set_times(Sweep& sweep) const;

  std::unique_ptr<PacketStream> stream_;
  SourceOptions options_;
  std::unique_ptr<PacketDecoder> decoder_;
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

/// A pcap or pcapng recording. @throws IoError with the ports and sizes found when no sensor that we know is in it.
std::unique_ptr<ScanSource> open_capture(const std::filesystem::path& file, const SourceOptions& options);

}  // namespace rilo::detail
