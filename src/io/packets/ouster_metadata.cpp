#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "geometry/degrees.hpp"
#include "io/file_bytes.hpp"
#include "io/packets/ouster.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

using nlohmann::json;
constexpr std::size_t kLargestFile = std::size_t{1} << 22;

struct ProfileRow {
  const char* name = "";
  OusterLayout layout;
};
// In the order of OusterProfile; numbers in the order of OusterLayout.
constexpr std::array<ProfileRow, 4> kProfiles{
    {{"LEGACY", {0, 16, 4, 12, 0, 0xFFFFF, 1, 4, true}},
     {"RNG15_RFL8_NIR8", {32, 12, 0, 4, 32, 0x7FFF, 8, 2, false}},
     {"RNG19_RFL8_SIG16_NIR16", {32, 12, 0, 12, 32, 0x7FFFF, 1, 4, false}},
     {"RNG19_RFL8_SIG16_NIR16_DUAL", {32, 12, 0, 16, 32, 0x7FFFF, 1, 3, false}}}};

class MetadataText {
 public:
  MetadataText(std::string_view text, std::filesystem::path file, std::string part)
      : file_(std::move(file)), part_(std::move(part)), root_(json::parse(text, nullptr, false)) {
    if (!root_.is_object()) reject("", "text that is not a JSON object");
  }

  [[noreturn]] void reject(const std::string& key, const std::string& found) const {
    const std::string position = part_ + (part_.empty() || key.empty() ? "" : ", ") + key;
    throw IoError({file_, position, found, "the metadata of an Ouster (get_metadata, or the file beside the recording)",
                   "Give the sensor's metadata with --sensor-file"});
  }

  /// Old files are flat; newer ones have the keys in sections.
  const json* find(const char* key) const {
    if (const auto at = root_.find(key); at != root_.end()) return &*at;
    for (const char* section :
         {"beam_intrinsics", "lidar_intrinsics", "lidar_data_format", "sensor_info", "config_params", "data_format"}) {
      const auto place = root_.find(section);
      if (place == root_.end() || !place->is_object()) continue;
      if (const auto at = place->find(key); at != place->end()) return &*at;
    }
    return nullptr;
  }

  std::string text(const char* key) const {
    const json* value = find(key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : "";
  }

  std::optional<double> number(const char* key) const {
    const json* value = find(key);
    if (value == nullptr || !value->is_number()) return std::nullopt;
    return value->get<double>();
  }

  /// A count from 1 to `most`.
  std::size_t count(const char* key, std::size_t otherwise, std::size_t most) const {
    const auto value = number(key);
    if (!value) return otherwise;
    if (!(*value >= 1 && *value <= static_cast<double>(most))) reject(key, std::to_string(*value));
    return static_cast<std::size_t>(*value);
  }

  std::vector<double> numbers(const char* key) const {
    const json* value = find(key);
    if (value == nullptr || !value->is_array()) reject(key, "no list of this name");
    std::vector<double> all;
    for (const json& entry : *value) {
      if (!entry.is_number()) reject(key, "an entry that is not a number");
      all.push_back(entry.get<double>());
    }
    return all;
  }

 private:
  std::filesystem::path file_;
  std::string part_;
  json root_;
};

OusterProfile profile_of(const MetadataText& file) {
  const std::string name = file.text("udp_profile_lidar");
  if (name.empty()) return OusterProfile::kLegacy;
  std::string known;
  for (std::size_t i = 0; i < kProfiles.size(); ++i) {
    if (name == kProfiles[i].name) return static_cast<OusterProfile>(i);
    known += (i == 0 ? "" : ", ") + std::string(kProfiles[i].name);
  }
  file.reject("udp_profile_lidar", in_quotes(name) + " (known: " + known + ")");
}

OusterIdentity identity_of(const MetadataText& file) {
  const double start = file.number("initialization_id").value_or(0);
  const bool is_start = start >= 0 && start < std::ldexp(1, 24);
  return {parse_unsigned(file.text("prod_sn")).value_or(0), is_start ? static_cast<std::uint32_t>(start) : 0};
}

// "1024x10": columns per revolution; the revolutions per second are those of the packets' times.
void read_mode(const MetadataText& file, OusterMetadata& metadata) {
  const std::string mode = file.text("lidar_mode");
  unsigned columns = 0;
  unsigned rate = 0;
  const bool known = std::sscanf(mode.c_str(), "%ux%u", &columns, &rate) == 2;  // NOLINT(cert-err34-c)
  if (!known || columns < 16 || columns > 8192 || rate < 1 || rate > 100) {
    file.reject("lidar_mode", mode.empty() ? "no such key" : in_quotes(mode));
  }
  metadata.columns_per_frame = file.count("columns_per_frame", columns, 8192);
  metadata.columns_sent = metadata.columns_per_frame;
}

// The first and the last column that are sent; the window may lie across the end of the revolution.
void read_window(const MetadataText& file, OusterMetadata& metadata) {
  if (file.find("column_window") == nullptr) return;
  const std::vector<double> window = file.numbers("column_window");
  const auto columns = static_cast<double>(metadata.columns_per_frame);
  for (const double end : window) {
    if (!(end >= 0 && end < columns)) file.reject("column_window", "column " + std::to_string(end));
  }
  if (window.size() != 2) file.reject("column_window", std::to_string(window.size()) + " numbers");
  const double sent = window[1] - window[0] + 1;
  metadata.columns_sent = static_cast<std::size_t>(sent > 0 ? sent : sent + columns);
}

void read_transform(const MetadataText& file, OusterMetadata& metadata) {
  constexpr double kMillimetres = 1e-3;
  // Of every sensor so far: turned by 180°, 36.18 mm up.
  metadata.T_sensor_lidar.diagonal() << -1, -1, 1, 1;
  metadata.T_sensor_lidar(2, 3) = 36.18 * kMillimetres;
  if (file.find("lidar_to_sensor_transform") == nullptr) return;
  const std::vector<double> values = file.numbers("lidar_to_sensor_transform");
  if (values.size() != 16) file.reject("lidar_to_sensor_transform", std::to_string(values.size()) + " numbers");
  for (Eigen::Index i = 0; i < 16; ++i) {
    const bool shift = i % 4 == 3 && i < 12;
    metadata.T_sensor_lidar(i / 4, i % 4) = values[static_cast<std::size_t>(i)] * (shift ? kMillimetres : 1);
  }
}

std::vector<double> in_radians(std::vector<double> degrees) {
  for (double& angle : degrees) angle *= kRadPerDeg;
  return degrees;
}

}  // namespace

OusterMetadata read_ouster_metadata(const std::filesystem::path& file) {
  return parse_ouster_metadata(read_file(file, kLargestFile).view(), file);
}

OusterMetadata parse_ouster_metadata(std::string_view text, const std::filesystem::path& path,
                                     const std::string& part) {
  const MetadataText file(text, path, part);
  OusterMetadata metadata;
  metadata.product = file.text("prod_line");
  metadata.identity = identity_of(file);
  metadata.profile = profile_of(file);
  read_mode(file, metadata);
  read_window(file, metadata);
  metadata.columns_per_packet = file.count("columns_per_packet", 16, 1024);
  metadata.elevations_rad = in_radians(file.numbers("beam_altitude_angles"));
  metadata.azimuths_rad = in_radians(file.numbers("beam_azimuth_angles"));
  const std::size_t beams = metadata.elevations_rad.size();
  if (beams == 0 || beams > 1024 || metadata.azimuths_rad.size() != beams) {
    file.reject("beam_azimuth_angles", std::to_string(metadata.azimuths_rad.size()) + " azimuths and " +
                                           std::to_string(beams) + " elevations");
  }
  if (file.count("pixels_per_column", beams, 1024) != beams) {
    file.reject("pixels_per_column", "another number than the " + counted(beams, "beam"));
  }
  constexpr double kFirstGenerationMm = 12.163;
  metadata.beam_origin_m = 1e-3 * file.number("lidar_origin_to_beam_origin_mm").value_or(kFirstGenerationMm);
  read_transform(file, metadata);
  return metadata;
}

OusterLayout ouster_layout(OusterProfile profile) { return kProfiles[static_cast<std::size_t>(profile)].layout; }
std::string to_string(OusterProfile profile) { return kProfiles[static_cast<std::size_t>(profile)].name; }

std::size_t ouster_packet_bytes(const OusterMetadata& metadata) {
  const OusterLayout layout = ouster_layout(metadata.profile);
  return layout.packet_header + metadata.columns_per_packet * layout.column_bytes(metadata.pixels()) +
         layout.packet_footer;
}

}  // namespace rilo::detail
