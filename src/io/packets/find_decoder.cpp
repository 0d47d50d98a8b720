#include "io/packets/find_decoder.hpp"

#include <algorithm>
#include <functional>
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
  // Ousters that say who they are, by the size of their packets.
  std::vector<std::pair<std::size_t, OusterIdentity>> sensors;

  // Those whose packets may be those of `metadata`.
  std::vector<OusterIdentity> sensors_of(const OusterMetadata& metadata) const {
    std::vector<OusterIdentity> all;
    if (metadata.profile == OusterProfile::kLegacy) return all;
    for (const auto& [bytes, sensor] : sensors) {
      if (bytes == ouster_packet_bytes(metadata)) all.push_back(sensor);
    }
    return all;
  }

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
    constexpr std::string_view kOfLidar("\x01\x00", 2);
    const std::pair sensor{kind.second, ouster_identity(datagram->payload)};
    auto& sensors = contents.sensors;
    if (flag == kOfLidar && sensor.second.serial != 0 && sensors.size() < kMostKinds &&
        std::find(sensors.begin(), sensors.end(), sensor) == sensors.end()) {
      sensors.push_back(sensor);
    }
  }
  return contents;
}

struct MetadataFile {
  fs::path file;
  OusterMetadata metadata;
};

// The .json files in a folder, by name.
struct Beside {
  std::vector<MetadataFile> usable;
  std::vector<IoProblem> others;  // why they are no metadata of an Ouster

  // Keeps the usable ones for which `same` is true, unless that is none.
  template <typename Same>
  void narrow(const Same& same) {
    if (std::any_of(usable.begin(), usable.end(), same)) std::erase_if(usable, std::not_fn(same));
  }

  std::string names() const {
    std::string list;
    for (const MetadataFile& one : usable) list += (list.empty() ? "" : ", ") + one.file.filename().string();
    return list;
  }
  std::string reasons() const {
    constexpr std::size_t kMost = 4;
    std::string list;
    for (std::size_t i = 0; i < others.size() && i < kMost; ++i) {
      const IoProblem& other = others[i];
      list += (i == 0 ? " (" : "; ") + other.file.filename().string() + ": " + other.position +
              (other.position.empty() ? "" : ": ") + other.found;
    }
    if (others.size() > kMost) list += "; and " + std::to_string(others.size() - kMost) + " more";
    return list.empty() ? "" : list + ")";
  }
};

Beside metadata_in(const fs::path& folder) {
  Beside beside;
  for (const fs::path& file : files_with(folder, {".json"})) {
    try {
      beside.usable.push_back({file, read_ouster_metadata(file)});
    } catch (const IoError& error) {
      beside.others.push_back(error.problem());  // perhaps some other JSON
    }
  }
  return beside;
}

// Of several files the one whose name belongs to the recording's: its beginning (the longest), or it with more behind.
std::optional<fs::path> of_the_name(const std::vector<MetadataFile>& files, const std::string& name) {
  std::optional<fs::path> shorter;
  std::vector<fs::path> longer;
  for (const auto& [file, metadata] : files) {
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
  Beside beside = metadata_in(in_folder ? named : named.parent_path());
  // By the sensor, and by its start where it was recorded more than once.
  const auto any_sensor = [&](const auto& same) {
    beside.narrow([&](const MetadataFile& one) {
      const std::vector<OusterIdentity> sensors = contents.sensors_of(one.metadata);
      return std::any_of(sensors.begin(), sensors.end(),
                         [&](const OusterIdentity& sensor) { return same(sensor, one.metadata.identity); });
    });
  };
  any_sensor([](const OusterIdentity& a, const OusterIdentity& b) { return a.serial == b.serial; });
  any_sensor(std::equal_to<>());
  if (beside.usable.size() == 1) return beside.usable[0].file;
  const std::string name = in_folder ? named.filename().string() : named.stem().string();
  if (const auto chosen = of_the_name(beside.usable, name)) return *chosen;
  throw IoError(
      {path, "",
       contents.text() + ", and " +
           (beside.usable.empty()
                ? "no metadata of an Ouster beside it" + beside.reasons()
                : std::to_string(beside.usable.size()) +
                      " metadata files of an Ouster beside it, and its name does not say which: " + beside.names()),
       "packets of a Velodyne (1206 bytes), or of an Ouster and its metadata",
       "Of an Ouster: name its metadata with --sensor-file. Of another sensor: record the point clouds that its driver "
       "makes of them. Else check that the right interface was recorded"});
}

// The metadata of another sensor: the angles of all beams would be wrong.
void check_sensor(const Contents& contents, const OusterMetadata& metadata, const fs::path& path,
                  const std::string& where) {
  const std::vector<OusterIdentity> sensors = contents.sensors_of(metadata);
  const std::uint64_t serial = metadata.identity.serial;
  const auto same = [&](const OusterIdentity& sensor) { return sensor.serial == serial; };
  if (serial == 0 || sensors.empty() || std::any_of(sensors.begin(), sensors.end(), same)) return;
  throw IoError({path, "", "packets of the Ouster with the serial number " + std::to_string(sensors[0].serial),
                 "those of " + std::to_string(serial) + ", as in " + where,
                 "Give the metadata of this very sensor with --sensor-file"});
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
  check_sensor(contents, metadata, path, where);
  return ouster_decoder(std::move(metadata));
}

}  // namespace rilo::detail
