// Zstandard and LZ4, with bounds on what comes out.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"

namespace rilo::detail {

/// No chunk and no message may be larger than this.
constexpr std::size_t kLargestUnpacked = std::size_t{1} << 30;

/// Unpack whole frames into `out`, which grows with what comes, not with what is announced.
/// @throws IoError: no such frame, damaged or cut off, more than `limit` bytes.
void unpack_zstd(std::string_view packed, std::size_t limit, const BytesOrigin& origin, std::vector<char>& out);
void unpack_lz4(std::string_view packed, std::size_t limit, const BytesOrigin& origin, std::vector<char>& out);

/// Unpacks a file piece by piece. @throws IoError.
void unpack_zstd_file(const std::filesystem::path& packed, const std::filesystem::path& to);

}  // namespace rilo::detail
