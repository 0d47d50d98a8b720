#include "io/ros/unpack.hpp"

#include <algorithm>
#include <fstream>
#include <lz4frame.h>
#include <memory>
#include <string>
#include <zstd.h>

#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

constexpr std::size_t kFirstStep = std::size_t{1} << 16;

[[noreturn]] void fail(const BytesOrigin& origin, const char* kind, const std::string& what) {
  throw IoError({origin.file, origin.part, std::string(kind) + " data that cannot be unpacked: " + what,
                 "whole compressed data", "It is cut off or damaged: copy or record it again"});
}

// Makes room behind `used`; false at the limit.
bool grow(std::vector<char>& out, std::size_t used, std::size_t limit) {
  if (used < out.size()) return true;
  if (out.size() >= limit) return false;
  out.resize(std::min(limit, std::max(kFirstStep, out.size() * 2)));
  return true;
}

struct ZstdFree {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};
struct Lz4Free {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

// `step` takes what it can of `taken` bytes into at most `written` and sets both to what it did; 0: the frame is whole.
template <typename Step>
void unpack(const char* kind, std::string_view packed, std::size_t limit, const BytesOrigin& origin,
            std::vector<char>& out, Step&& step) {
  out.resize(std::min(limit, std::max(kFirstStep, packed.size())));
  std::size_t place = 0;
  std::size_t used = 0;
  std::size_t wanted = packed.empty() ? 0 : 1;
  while (place < packed.size() || wanted != 0) {
    const bool room = grow(out, used, limit);
    std::size_t written = out.size() - used;
    std::size_t taken = packed.size() - place;
    wanted = step(out.data() + used, written, packed.data() + place, taken);
    used += written;
    place += taken;
    if (written > 0 || taken > 0) continue;
    if (!room) fail(origin, kind, "more than " + counted(limit, "byte") + " come out");
    if (place == packed.size()) fail(origin, kind, "it ends too early");
  }
  out.resize(used);
}

}  // namespace

void unpack_zstd(std::string_view packed, std::size_t limit, const BytesOrigin& origin, std::vector<char>& out) {
  const std::unique_ptr<ZSTD_DCtx, ZstdFree> context(ZSTD_createDCtx());
  unpack("zstd", packed, limit, origin, out, [&](char* to, std::size_t& written, const char* from, std::size_t& taken) {
    ZSTD_inBuffer in{from, taken, 0};
    ZSTD_outBuffer piece{to, written, 0};
    const std::size_t wanted = ZSTD_decompressStream(context.get(), &piece, &in);
    if (ZSTD_isError(wanted) != 0) fail(origin, "zstd", ZSTD_getErrorName(wanted));
    written = piece.pos;
    taken = in.pos;
    return wanted;
  });
}

void unpack_lz4(std::string_view packed, std::size_t limit, const BytesOrigin& origin, std::vector<char>& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, Lz4Free> context(raw);
  unpack("lz4", packed, limit, origin, out, [&](char* to, std::size_t& written, const char* from, std::size_t& taken) {
    const std::size_t wanted = LZ4F_decompress(context.get(), to, &written, from, &taken, nullptr);
    if (LZ4F_isError(wanted) != 0) fail(origin, "lz4", LZ4F_getErrorName(wanted));
    return wanted;
  });
}

void unpack_zstd_file(const std::filesystem::path& packed, const std::filesystem::path& to) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 20;
  const RandomAccessFile file(packed);
  const BytesOrigin origin{packed, ""};
  std::ofstream stream(to, std::ios::binary | std::ios::trunc);
  const std::unique_ptr<ZSTD_DCtx, ZstdFree> context(ZSTD_createDCtx());
  std::vector<char> input;
  std::vector<char> output(ZSTD_DStreamOutSize());
  const auto check_written = [&] {
    if (stream) return;
    throw IoError({to, "", "the unpacked " + packed.filename().string() + " cannot be written", "room for it",
                   "Free space there, or set TMPDIR to a folder on a larger disk"});
  };
  std::size_t wanted = 1;
  for (std::uint64_t place = 0; place < file.size(); place += kPiece) {
    file.read(place, static_cast<std::size_t>(std::min(kPiece, file.size() - place)), input);
    ZSTD_inBuffer in{input.data(), input.size(), 0};
    bool full = false;  // the output was: there is more
    while (in.pos < in.size || full) {
      ZSTD_outBuffer piece{output.data(), output.size(), 0};
      wanted = ZSTD_decompressStream(context.get(), &piece, &in);
      if (ZSTD_isError(wanted) != 0) fail(origin, "zstd", ZSTD_getErrorName(wanted));
      stream.write(output.data(), static_cast<std::streamsize>(piece.pos));
      check_written();  // a recording may be a hundred times the room that is left
      full = piece.pos == piece.size && wanted != 0;
    }
  }
  if (wanted != 0) fail(origin, "zstd", "it ends too early");
  stream.close();
  check_written();
}

}  // namespace rilo::detail
