#include "io/folders/sweep_files.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/folders/stamp_list.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::array<const char*, 3> kFormats{"bin", "pcd", "ply"};

// Without extensions; nuScenes has NAME.pcd.bin.
std::string name_of(const fs::path& file) {
  const fs::path stem = file.stem();
  return (sweep_format(stem).empty() ? stem : stem.stem()).string();
}

constexpr const char* kDigits = "0123456789";

// Newer College has cloud_1583836591_182590976.pcd: with a point between seconds and ns.
std::string with_decimals(std::string name) {
  constexpr std::size_t kSecondDigits = 10;
  constexpr std::size_t kNanosecondDigits = 9;
  const auto digits_from = [&](std::size_t begin) {
    return std::min(name.find_first_not_of(kDigits, begin), name.size()) - begin;
  };
  for (std::size_t begin = name.find_first_of(kDigits); begin < name.size();) {
    const std::size_t end = begin + digits_from(begin);
    const bool divided = end < name.size() && (name[end] == '_' || name[end] == '-');
    if (end - begin == kSecondDigits && divided && digits_from(end + 1) == kNanosecondDigits) name[end] = '.';
    begin = name.find_first_of(kDigits, end);
  }
  return name;
}

// The name, or the one part of it that is a stamp: nuScenes has LOG__LIDAR_TOP__1532402927647951.pcd.bin.
std::optional<std::int64_t> stamp_in_name(const fs::path& file) {
  const std::string name = with_decimals(name_of(file));
  std::optional<std::int64_t> found;
  for (std::size_t begin = name.find_first_of(kDigits); begin < name.size();) {
    const std::size_t end = std::min(name.find_first_not_of("0123456789.", begin), name.size());
    const auto stamp = parse_long_stamp(name.substr(begin, end - begin));
    if (stamp && found) return std::nullopt;
    if (stamp) found = stamp;
    begin = name.find_first_of(kDigits, end);
  }
  return found;
}

// Decimal seconds by their value: natural order takes their decimals for whole numbers, and these are as long as
// whoever wrote them found necessary.
std::optional<std::int64_t> seconds_of(const fs::path& file) {
  const std::string name = name_of(file);
  return name.find_first_not_of("0123456789.") == std::string::npos ? parse_stamp(name) : std::nullopt;
}

// False where a file has none.
template <typename StampOf>
bool sort_by(const StampOf& stamp_of, std::vector<fs::path>& files) {
  std::vector<std::pair<std::int64_t, fs::path>> stamped;
  for (const fs::path& file : files) {
    const std::optional<std::int64_t> stamp = stamp_of(file);
    if (!stamp) return false;
    stamped.emplace_back(*stamp, file);
  }
  std::sort(stamped.begin(), stamped.end());
  std::transform(stamped.begin(), stamped.end(), files.begin(), [](const auto& one) { return one.second; });
  return true;
}

struct FolderContent {
  std::array<std::vector<fs::path>, kFormats.size()> sweeps;
  std::map<std::string, std::size_t> others;  // by their extension
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
    if (is_hidden(entry->path())) continue;
    const auto kind = std::find(kFormats.begin(), kFormats.end(), sweep_format(entry->path()));
    if (kind == kFormats.end()) {
      ++content.others[lower_case(entry->path().extension().string())];
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

struct Subfolder {
  std::string place;
  SweepFiles inside;
};

// The first subfolder (also two levels down) that holds sweeps.
std::optional<Subfolder> subfolder_with_sweeps(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    for (const char* below : {"", "data"}) {
      const std::string place = *below == 0 ? name : name + "/" + below;
      if (!is_folder(folder / place)) continue;
      try {
        return Subfolder{place, find_sweep_files(folder / place, false)};
      } catch (const IoError&) {
        // Nothing there either, or more than one kind.
      }
    }
  }
  return std::nullopt;
}

std::string what_to_give(const fs::path& folder) {
  if (const std::vector<fs::path> arrays = files_with(folder, {".npy"}); !arrays.empty()) {
    return "Make a .bin of x, y, z of each array: numpy.load(\"" + arrays[0].filename().string() +
           "\")[:, :3].astype(\"<f4\").tofile(\"" + arrays[0].stem().string() +
           ".bin\"), and give --bin-fields x,y,z; or register them from Python, with their times";
  }
  return std::string("Give the folder that holds the sweeps themselves. ") + kOtherFormats;
}

// "12 other files, mostly .las"
std::string text_of(const std::map<std::string, std::size_t>& others) {
  std::size_t files = 0;
  std::pair<std::size_t, std::string> most;
  for (const auto& [extension, of_it] : others) {
    files += of_it;
    if (of_it > most.first && !extension.empty()) most = {of_it, extension};
  }
  return counted(files, "other file") + (most.first > 0 ? ", mostly " + most.second : "");
}

[[noreturn]] void reject_without_sweeps(const fs::path& folder, FolderContent content, bool look_below) {
  constexpr const char* kExpected = "sweeps, or a KITTI sequence folder with velodyne/ in it";
  std::sort(content.folders.begin(), content.folders.end(), natural_less);
  std::string found = "no sweeps here (.bin, .pcd, .ply)";
  if (const auto below = look_below ? subfolder_with_sweeps(folder, content.folders) : std::nullopt) {
    const std::size_t sweeps = below->inside.files.size();
    const bool one_each = sweeps == 1 && content.folders.size() > 1;
    found += "; subfolder " + below->place + "/ has " + std::to_string(sweeps) + " ." + below->inside.format;
    throw IoError({folder, "", found, kExpected,
                   one_each ? "Put the sweeps of all the subfolders into one folder, named by their order"
                            : "Give that subfolder"});
  }
  found += ", " + text_of(content.others);
  constexpr std::size_t kMostNames = 5;
  for (std::size_t i = 0; i < std::min(content.folders.size(), kMostNames); ++i) {
    found += (i == 0 ? " and the folders " : ", ") + content.folders[i];
  }
  if (content.folders.size() > kMostNames) found += ", …";
  throw IoError({folder, "", found, kExpected, what_to_give(folder)});
}

}  // namespace

std::string sweep_format(const fs::path& file) {
  const std::string extension = lower_case(file.extension().string());
  for (const char* format : kFormats) {
    if (extension == std::string(".") + format) return format;
  }
  return {};
}

SweepFiles find_sweep_files(const fs::path& folder, bool look_below) {
  FolderContent content = content_of(folder);
  std::string counts;
  std::size_t kinds = 0;
  SweepFiles found;
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (content.sweeps[i].empty()) continue;
    counts += (kinds++ == 0 ? "" : " and ") + std::to_string(content.sweeps[i].size()) + " ." + kFormats[i];
    found = {kFormats[i], std::move(content.sweeps[i])};
  }
  if (kinds == 0) reject_without_sweeps(folder, std::move(content), look_below);
  if (kinds > 1) {
    throw IoError(
        {folder, "", counts + " files", "sweeps of one kind", "Move the other files into a folder of their own"});
  }
  if (!sort_by(seconds_of, found.files) && !sort_by(stamp_in_name, found.files)) sort_naturally(found.files);
  return found;
}

std::vector<std::int64_t> stamps_from_names(const std::vector<fs::path>& files) {
  std::vector<std::int64_t> stamps;
  for (const fs::path& file : files) {
    const auto stamp = stamp_in_name(file);
    if (!stamp || (!stamps.empty() && *stamp <= stamps.back())) return {};
    stamps.push_back(*stamp);
  }
  return stamps;
}

}  // namespace rilo::detail
