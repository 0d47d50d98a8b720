// pcap and pcapng files: which files are, and several of one recording.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "io/packets/packet_stream.hpp"

namespace rilo::detail {

/// Whether it is a file named .pcap or .pcapng, or one of no kind that we know which begins as these do: tcpdump and
/// Wireshark name them otherwise, too (drive.pcap1, drive.cap, drive).
bool is_capture(const std::filesystem::path& file);

/// The captures in a folder, in natural order, hidden files left out; nothing where it cannot be listed.
std::vector<std::filesystem::path> captures_in(const std::filesystem::path& folder);

/// One recording in several files, as tcpdump -C and ring buffers write it, in the order of the times of their first
/// datagrams. Files that cannot be read, or without a datagram, are left out, with a warning; so there is one where a
/// file does not go on where the one before ended.
/// @throws IoError, of the first file, when none can be read.
std::unique_ptr<PacketStream> in_turn(const std::vector<std::filesystem::path>& files);

}  // namespace rilo::detail
