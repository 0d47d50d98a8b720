// LZF, the compression of PCD's binary_compressed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace rilo::detail {

/// No input expands by more than this: three bytes copy at most 264.
inline constexpr std::size_t kLzfLargestExpansion = 88;

/// Decompresses into exactly `output`. Returns nothing when that went well, else the offset in `input` where it does
/// not fit.
std::optional<std::size_t> lzf_decompress(std::string_view input, std::span<char> output);

}  // namespace rilo::detail
