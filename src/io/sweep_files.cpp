// Which files of a folder are sweeps, and in which order.
#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>

#include "io/scan_listing.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/pose_writer.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::array<const char*, 3> kFormats{"bin", "pcd", "ply"};

bool is_digit(char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; }
bool all_digits(std::string_view text) { return !text.empty() && std::all_of(text.begin(), text.end(), is_digit); }

// The number that starts at `place`, without leading zeros; moves `place` behind it.
std::string_view take_number(std::string_view text, std::size_t& place) {
  while (place + 1 < text.size() && text[place] == '0' && is_digit(text[place + 1])) ++place;
  const std::size_t begin = place;
  while (place < text.size() && is_digit(text[place])) ++place;
  return text.substr(begin, place - begin);
}

struct FolderContent {
  std::array<std::vector<fs::path>, kFormats.size()> sweeps;
  std::size_t others = 0;
  std::vector<std::string> folders;
};

FolderContent content_of(const fs::path& folder) {
  FolderContent content;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      content.folders.push_back(entry->path().filename().string());
      continue;
    }
    const auto kind = std::find(kFormats.begin(), kFormats.end(), sweep_format(entry->path()));
    if (kind == kFormats.end()) {
      ++content.others;
    } else {
      content.sweeps[static_cast<std::size_t>(kind - kFormats.begin())].push_back(entry->path());
    }
  }
  if (error) {
    throw IoError(
        {folder, "", "the folder cannot be listed: " + error.message(), "a readable folder", "Check the path"});
  }
  return content;
}

[[noreturn]] void refuse_without_sweeps(const fs::path& folder, FolderContent content) {
  std::string found = "no .bin, .pcd or .ply in the folder, " + std::to_string(content.others) + " other files";
  std::sort(content.folders.begin(), content.folders.end(), natural_less);
  constexpr std::size_t kMostNames = 5;
  for (std::size_t i = 0; i < std::min(content.folders.size(), kMostNames); ++i) {
    found += (i == 0 ? " and the folders " : ", ") + content.folders[i];
  }
  if (content.folders.size() > kMostNames) found += ", …";
  throw IoError({folder, "", found, "sweeps, or a KITTI sequence folder with velodyne/ in it",
                 "Give the folder that holds the sweeps themselves"});
}

// 19 digits: ns; 16: µs; 1234567890.123…: s.
std::optional<std::int64_t> stamp_from_name(const std::string& name) {
  constexpr std::size_t kNanosecondDigits = 19;
  constexpr std::size_t kMicrosecondDigits = 16;
  constexpr std::size_t kSecondDigits = 9;
  if (all_digits(name)) {
    if (name.size() == kNanosecondDigits) return parse_integer(name);
    const auto microseconds = name.size() == kMicrosecondDigits ? parse_integer(name) : std::nullopt;
    return microseconds ? std::optional(*microseconds * 1000) : std::nullopt;
  }
  const std::size_t point = name.find('.');
  if (point == std::string::npos || point < kSecondDigits) return std::nullopt;
  const std::string_view view(name);
  if (!all_digits(view.substr(0, point)) || !all_digits(view.substr(point + 1))) return std::nullopt;
  return parse_stamp(name);
}

}  // namespace

std::string sweep_format(const fs::path& file) {
  const std::string extension = lower_case(file.extension().string());
  for (const char* format : kFormats) {
    if (extension == std::string(".") + format) return format;
  }
  return {};
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t k = 0;
  while (i < a.size() && k < b.size()) {
    if (is_digit(a[i]) && is_digit(b[k])) {
      const std::string_view first = take_number(a, i);
      const std::string_view second = take_number(b, k);
      if (first.size() != second.size()) return first.size() < second.size();
      if (first != second) return first < second;
    } else {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i;
      ++k;
    }
  }
  if ((i < a.size()) != (k < b.size())) return k < b.size();
  return a < b;  // 1.bin and 01.bin: some order, always the same
}

SweepFiles find_sweep_files(const fs::path& folder) {
  FolderContent content = content_of(folder);
  std::string counts;
  std::size_t kinds = 0;
  SweepFiles found;
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (content.sweeps[i].empty()) continue;
    counts += (kinds++ == 0 ? "" : " and ") + std::to_string(content.sweeps[i].size()) + " ." + kFormats[i];
    found = {kFormats[i], std::move(content.sweeps[i])};
  }
  if (kinds == 0) refuse_without_sweeps(folder, std::move(content));
  if (kinds > 1) {
    throw IoError(
        {folder, "", counts + " files", "sweeps of one kind", "Move the other files into a folder of their own"});
  }
  std::sort(found.files.begin(), found.files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return found;
}

std::vector<std::int64_t> stamps_from_names(const std::vector<fs::path>& files) {
  std::vector<std::int64_t> stamps;
  for (const fs::path& file : files) {
    fs::path stem = file.stem();
    if (!sweep_format(stem).empty()) stem = stem.stem();  // nuScenes: NAME.pcd.bin
    const auto stamp = stamp_from_name(stem.string());
    if (!stamp || (!stamps.empty() && *stamp <= stamps.back())) return {};
    stamps.push_back(*stamp);
  }
  return stamps;
}

}  // namespace rilo::detail
