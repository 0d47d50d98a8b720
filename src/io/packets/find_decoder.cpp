#include "io/packets/find_decoder.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/packets/ouster.hpp"
#include "io/packets/velodyne.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kPacketsLookedAt = 2000;

// What the first packets are.
struct Contents {
  std::map<std::pair<std::uint16_t, std::size_t>, std::size_t> counts;  // port, size → how many
  std::string velodyne;                                                 // one of its packets

  std::string text() const {
    std::string all;
    for (const auto& [kind, count] : counts) {
      all += (all.empty() ? "" : ", ") + std::to_string(count) + " of " + counted(kind.second, "byte") +
             (kind.first == 0 ? "" : " to port " + std::to_string(kind.first));
    }
    return all.empty() ? "no packets" : "packets: " + all;
  }
};

Contents contents_of(PacketStream& stream) {
  constexpr std::size_t kMostKinds = 8;
  Contents contents;
  for (std::size_t i = 0; i < kPacketsLookedAt; ++i) {
    std::optional<Datagram> datagram;
    try {
      datagram = stream.next();
    } catch (const IoError&) {
      continue;  // reported when it is reached
    }
    if (!datagram) break;
    const std::pair kind{datagram->port, datagram->payload.size()};
    if (contents.counts.size() < kMostKinds || contents.counts.contains(kind)) ++contents.counts[kind];
    const std::string_view flag = datagram->payload.substr(0, 2);
    const bool velodyne = datagram->payload.size() == kVelodynePacket && (flag == "\xFF\xEE" || flag == "\xFF\xDD");
    if (velodyne && contents.velodyne.empty()) contents.velodyne = std::string(datagram->payload);
  }
  return contents;
}

// The .json files in `folder` that are metadata of an Ouster, by name.
std::vector<fs::path> metadata_in(const fs::path& folder) {
  std::vector<fs::path> found = files_with(folder, {".json"});
  std::erase_if(found, [](const fs::path& file) {
    try {
      static_cast<void>(read_ouster_metadata(file));
      return false;
    } catch (const IoError&) {
      return true;  // some other JSON
    }
  });
  return found;
}

// Of several files the one whose name belongs to the recording's: its beginning (the longest), or it with more behind.
std::optional<fs::path> of_the_name(const std::vector<fs::path>& files, const std::string& name) {
  std::optional<fs::path> shorter;
  std::vector<fs::path> longer;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    if (stem.starts_with(name)) longer.push_back(file);
    if (name.starts_with(stem) && (!shorter || stem.size() > shorter->stem().string().size())) shorter = file;
  }
  if (longer.size() == 1) return longer[0];
  return longer.empty() ? shorter : std::nullopt;
}

fs::path find_metadata(const fs::path& path, const Contents& contents) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error).lexically_normal();
  const bool in_folder = is_folder(path);
  const fs::path named = whole.has_filename() ? whole : whole.parent_path();  // "bag/" is "bag"
  fs::path twin = in_folder ? fs::path(named).concat(".json") : fs::path(named).replace_extension(".json");
  if (path_exists(twin)) return twin;
  const std::vector<fs::path> found = metadata_in(in_folder ? named : named.parent_path());
  if (found.size() == 1) return found[0];
  const std::string name = in_folder ? named.filename().string() : named.stem().string();
  if (const auto chosen = of_the_name(found, name)) return *chosen;
  std::string list;
  for (const fs::path& file : found) list += (list.empty() ? ": " : ", ") + file.filename().string();
  throw IoError(
      {path, "",
       contents.text() + ", and " +
           (found.empty() ? "no metadata of an Ouster beside it"
                          : std::to_string(found.size()) +
                                " metadata files of an Ouster beside it, and its name does not say which" + list),
       "packets of a Velodyne (1206 bytes), or of an Ouster and its metadata",
       "Name the Ouster's metadata with --sensor-file; check that the right interface was recorded"});
}

}  // namespace

std::unique_ptr<PacketDecoder> find_decoder(PacketStream& stream, const fs::path& path, const SourceOptions& options,
                                            const RecordedMetadata& recorded) {
  const Contents contents = contents_of(stream);
  if (!contents.velodyne.empty()) return velodyne_decoder(velodyne_model(contents.velodyne, path, options.sensor_file));
  OusterMetadata metadata;
  std::string where;
  if (options.sensor_file.empty() && !recorded.text.empty()) {
    metadata = parse_ouster_metadata(recorded.text, path, recorded.part);
    where = recorded.part;
  } else {
    const fs::path file = options.sensor_file.empty() ? find_metadata(path, contents) : fs::path(options.sensor_file);
    metadata = read_ouster_metadata(file);
    where = file.string();
  }
  const std::size_t bytes = ouster_packet_bytes(metadata);
  const auto fits = [&](const auto& kind) { return kind.first.second == bytes; };
  if (std::none_of(contents.counts.begin(), contents.counts.end(), fits)) {
    throw IoError({path, "", contents.text(), "packets of " + counted(bytes, "byte") + ", as in " + where,
                   "Give the metadata of this very recording with --sensor-file"});
  }
  return ouster_decoder(std::move(metadata));
}

}  // namespace rilo::detail
