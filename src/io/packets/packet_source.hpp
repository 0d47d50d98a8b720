// Sweeps from the recorded packets of a sensor.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/packets/packet_decoder.hpp"
#include "io/packets/packet_stream.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// `path`, as given, and `topic` (empty for a capture) are for info() and messages.
std::unique_ptr<ScanSource> packet_source(const std::filesystem::path& path, const std::string& topic,
                                          std::unique_ptr<PacketStream> stream, std::unique_ptr<PacketDecoder> decoder,
                                          const SourceOptions& options);

/// A pcap or pcapng recording. @throws IoError with the ports and sizes found when no sensor that we know is in it.
std::unique_ptr<ScanSource> open_capture(const std::filesystem::path& file, const SourceOptions& options);

}  // namespace rilo::detail
