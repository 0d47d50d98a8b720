#include "io/packets/captures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/packets/udp_reader.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

bool begins_as_capture(const fs::path& file) {
  constexpr std::array<std::string_view, 5> kMagic{"\xD4\xC3\xB2\xA1", "\xA1\xB2\xC3\xD4", "\x4D\x3C\xB2\xA1",
                                                   "\xA1\xB2\x3C\x4D", "\x0A\x0D\x0D\x0A"};
  try {
    const FileBytes start = read_file(file, kMagic[0].size());
    return std::find(kMagic.begin(), kMagic.end(), start.view()) != kMagic.end();
  } catch (const IoError&) {
    return false;
  }
}

class CapturesInTurn final : public PacketStream {
 public:
  explicit CapturesInTurn(const std::vector<fs::path>& files) {
    std::optional<IoError> failure;
    for (const fs::path& file : files) {
      try {
        if (const auto first = UdpReader(file).next()) {
          parts_.push_back({first->received_ns, file});
        } else {
          warnings_.push_back("left out: " + file.string() + ", which has no UDP packets");
        }
      } catch (const IoError& error) {
        if (!failure) failure = error;
        warnings_.push_back(std::string("left out: ") + error.what());
      }
    }
    if (parts_.empty()) {
      throw failure ? *failure
                    : IoError({files.front(), "", "no UDP packets", "packets of a LiDAR", "Check what was recorded"});
    }
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Part& a, const Part& b) { return a.begins_ns < b.begins_ns; });
  }

  std::optional<Datagram> next() override {
    while (current_ || place_ < parts_.size()) {
      if (!current_) open_next();
      if (auto datagram = current_->next()) {
        last_ns_ = datagram->received_ns;
        return datagram;
      }
      shortened_ = shortened_ || current_->shortened();
      for (std::string& warning : current_->warnings()) {
        warnings_.push_back(parts_[place_ - 1].file.filename().string() + ": " + warning);
      }
      current_.reset();
    }
    return std::nullopt;
  }

  bool is_mixed() const override { return true; }
  bool shortened() const override { return shortened_; }
  std::vector<std::string> warnings() const override { return warnings_; }

 private:
  struct Part {
    std::int64_t begins_ns = 0;
    fs::path file;
  };

  void open_next() {
    constexpr double kLongestPauseS = 1;
    const Part& part = parts_[place_++];
    const double pause_s = last_ns_ ? seconds_between(*last_ns_, part.begins_ns) : 0;
    if (std::abs(pause_s) > kLongestPauseS) {
      warnings_.push_back(
          fmt::format("{} begins {:.3g} s {} {} ends: these may be two drives; give one file to run one",
                      part.file.filename().string(), std::abs(pause_s), pause_s > 0 ? "after" : "before",
                      parts_[place_ - 2].file.filename().string()));
    }
    current_ = std::make_unique<UdpReader>(part.file);
  }

  std::vector<Part> parts_;
  std::size_t place_ = 0;  // of the part after the current one
  std::unique_ptr<UdpReader> current_;
  std::optional<std::int64_t> last_ns_;
  bool shortened_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace

bool is_capture(const fs::path& file) {
  const std::string extension = lower_case(file.extension().string());
  if (extension == ".pcap" || extension == ".pcapng") return true;
  constexpr std::array<std::string_view, 7> kOthers{".bin", ".pcd", ".ply", ".bag", ".mcap", ".db3", ".zstd"};
  if (std::find(kOthers.begin(), kOthers.end(), extension) != kOthers.end()) return false;
  return is_file(file) && begins_as_capture(file);
}

std::vector<fs::path> captures_in(const fs::path& folder) { return files_that(folder, is_capture); }

std::unique_ptr<PacketStream> in_turn(const std::vector<fs::path>& files) {
  return std::make_unique<CapturesInTurn>(files);
}

}  // namespace rilo::detail
