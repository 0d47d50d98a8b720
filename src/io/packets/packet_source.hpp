// Sweeps from the recorded packets of a sensor.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/packets/packet_decoder.hpp"
#include "io/packets/packet_stream.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// `path`, as given, and `topic` (empty for a capture) are for info() and messages.
std::unique_ptr<ScanSource> packet_source(const std::filesystem::path& path, const std::string& topic,
                                          std::unique_ptr<PacketStream> stream, std::unique_ptr<PacketDecoder> decoder,
                                          const SourceOptions& options);

/// A pcap or pcapng recording, or one in several files (see in_turn()). `path`, as given, is for info() and
/// messages. @throws IoError with the ports and sizes found when no sensor that we know is in it.
std::unique_ptr<ScanSource> open_captures(const std::filesystem::path& path,
                                          const std::vector<std::filesystem::path>& files,
                                          const SourceOptions& options);

}  // namespace rilo::detail
