// Sweeps from a pcap recording of a sensor's packets.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/packets/packet_decoder.hpp"
#include "io/packets/udp_reader.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

class PacketSource final : public ScanSource {
 public:
  /// Finds out which sensor it is. @throws IoError with the ports and sizes found when it is none that we know.
  PacketSource(const std::filesystem::path& file, const SourceOptions& options);

  std::optional<Sweep> next() override;
  std::size_t skip(std::size_t count) override;
  std::optional<std::size_t> size() const override { return std::nullopt; }
  std::size_t current_index() const override { return given_ == 0 ? 0 : given_ - 1; }
  std::string current_name() const override;
  SourceInfo info() const override;

 private:
  void fill();
  void refuse_shortened();
  void find_period();
  void set_times(Sweep& sweep) const;

  UdpReader reader_;
  SourceOptions options_;
  std::unique_ptr<PacketDecoder> decoder_;
  SourceInfo info_;
  std::deque<DecodedSweep> ready_;
  std::size_t given_ = 0;
  std::size_t left_out_ = 0;  // the parts of a turn at the beginning and the end
  bool started_ = false;
  bool refused_ = false;
  bool ended_ = false;
};

}  // namespace rilo::detail
