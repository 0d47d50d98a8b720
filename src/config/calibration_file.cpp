#include "rilo/config/calibration_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "cloud/beam_index.hpp"
#include "config/yaml_document.hpp"
#include "geometry/degrees.hpp"
#include "io/text.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo {
namespace {

using detail::kind_of;
using detail::position_of;

constexpr const char* kCorrection = "elevation_correction_deg";
constexpr const char* kRecordings = "recordings";
constexpr const char* kOffset = "elevation_offset_deg";
constexpr const char* kEstimate = "elevation_estimate_deg";
constexpr const char* kSigma = "elevation_sigma_deg";
constexpr const char* kBeamList = "beams";
constexpr std::string_view kEnd = "...";  // of a YAML document
constexpr const char* kExpectedFile = "calibration.yaml as rilo run leaves it among its results";
constexpr const char* kExpectedBeam = "[beam, elevation, added to elevation, added to azimuth], in degrees";
// Beyond these a number is a mistake: errors of sensors are tenths of a degree.
constexpr double kMostOffsetDeg = 10.0;
constexpr double kLeastSigmaDeg = 1e-4;
constexpr double kMostCorrectionDeg = 2.0;
constexpr double kMostElevationDeg = 90.0;

class CalibrationLoader {
 public:
  explicit CalibrationLoader(std::string file) : file_(std::move(file)) {}

  SensorAngles load(const YAML::Node& root) {
    if (!root.IsMap()) refuse(root, kind_of(root), kExpectedFile);
    SensorAngles angles;
    for (const auto& pair : root) {
      const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : kind_of(pair.first);
      if (!keys_.insert(key).second) refuse(pair.first, key + " is given a second time", "each key once");
      if (key == kCorrection) {
        angles.elevation_correction_deg = number(pair.second, kCorrection, -kMostOffsetDeg, kMostOffsetDeg);
      } else if (key == kRecordings) {
        angles.recordings = texts(pair.second);
      } else if (key == kOffset) {
        angles.elevation_offset_rad = kRadPerDeg * number(pair.second, kOffset, -kMostOffsetDeg, kMostOffsetDeg);
      } else if (key == kEstimate) {
        angles.elevation_estimate.rad = kRadPerDeg * number(pair.second, kEstimate, -kMostOffsetDeg, kMostOffsetDeg);
      } else if (key == kSigma) {
        angles.elevation_estimate.sigma_rad =
            kRadPerDeg * number(pair.second, kSigma, kLeastSigmaDeg, kMostElevationDeg);
      } else if (key == kBeamList) {
        angles.beams = beams(pair.second);
      } else {
        refuse(pair.first, "unknown key " + detail::quoted(key),
               fmt::format("one of {}, {}, {}, {}, {} and {}", kCorrection, kRecordings, kOffset, kEstimate, kSigma,
                           kBeamList));
      }
    }
    for (const char* key : {kOffset, kBeamList}) {
      if (!keys_.contains(key)) refuse(root, std::string("no ") + key, kExpectedFile);
    }
    if (keys_.contains(kEstimate) != keys_.contains(kSigma)) {
      refuse(root, std::string("only one of ") + kEstimate + " and " + kSigma, "both or none");
    }
    return angles;
  }

 private:
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& found, const std::string& expected) const {
    throw ConfigError({file_, position_of(node.Mark()), found, expected, ""});
  }

  double number(const YAML::Node& node, const std::string& name, double least, double most) const {
    const std::string expected = fmt::format("a number from {} to {}", least, most);
    if (!node.IsScalar()) refuse(node, name + " is " + kind_of(node), expected);
    const std::string& text = node.Scalar();
    const std::optional<double> value = detail::parse_double(text);
    if (!value || !(*value >= least && *value <= most)) refuse(node, name + " is " + detail::quoted(text), expected);
    return *value;
  }

  std::vector<std::string> texts(const YAML::Node& list) const {
    if (!list.IsSequence()) refuse(list, std::string(kRecordings) + " is " + kind_of(list), "a list of paths");
    std::vector<std::string> all;
    for (const YAML::Node& entry : list) {
      if (!entry.IsScalar()) refuse(entry, kind_of(entry), "a path");
      all.push_back(entry.Scalar());
    }
    return all;
  }

  std::vector<BeamCorrection> beams(const YAML::Node& list) const {
    if (!list.IsSequence()) refuse(list, std::string(kBeamList) + " is " + kind_of(list), "a list of beams");
    std::vector<BeamCorrection> all;
    std::set<std::uint16_t> seen;
    for (const YAML::Node& entry : list) {
      if (!entry.IsSequence() || entry.size() != 4) refuse(entry, kind_of(entry), kExpectedBeam);
      const double index = number(entry[0], "a beam", 0, kBeams - 1);
      if (index != std::floor(index)) refuse(entry[0], "a beam is " + kind_of(entry[0]), "a whole number");
      const auto beam = static_cast<std::uint16_t>(index);
      if (!seen.insert(beam).second) refuse(entry, fmt::format("beam {} a second time", beam), "each beam once");
      all.push_back({beam, kRadPerDeg * number(entry[1], "an elevation", -kMostElevationDeg, kMostElevationDeg),
                     kRadPerDeg * number(entry[2], "a correction", -kMostCorrectionDeg, kMostCorrectionDeg),
                     kRadPerDeg * number(entry[3], "a correction", -kMostCorrectionDeg, kMostCorrectionDeg)});
    }
    return all;
  }

  std::string file_;
  std::set<std::string> keys_;
};

// A path may hold anything, a comment ends with its line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

std::string in_yaml(const std::string& text) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

// A list that is cut off between two beams is a list.
bool is_whole(std::string_view yaml) {
  std::string_view last;
  detail::LineScanner lines(yaml);
  while (const auto line = lines.next()) {
    if (!detail::trimmed(*line).empty()) last = *line;
  }
  return last.starts_with(kEnd);
}

}  // namespace

SensorAngles parse_calibration(std::string_view yaml, const std::string& name) {
  SensorAngles angles = CalibrationLoader(name).load(
      detail::parse_yaml(yaml, name, "rilo run leaves calibration.yaml among its results"));
  if (!is_whole(yaml)) {
    throw ConfigError({name, "", "the end is missing", "a last line " + detail::quoted(std::string(kEnd)),
                       "It is cut off: copy it again, or let rilo run make a new one"});
  }
  angles.name = name;
  return angles;
}

SensorAngles load_calibration(const std::filesystem::path& file) {
  const std::string text = detail::read_yaml_file(file, kExpectedFile, "`rilo run DATA --out FOLDER` makes one");
  return parse_calibration(text, file.string());
}

std::string dump_calibration(const SensorAngles& angles, const std::string& source) {
  std::string text = fmt::format(
      "# Errors of the sensor's angles, learnt from {}.\n"
      "# For other recordings of the same sensor, read in the same way: rilo run DATA --calibration FILE\n",
      one_line(source));
  if (!angles.recordings.empty()) {
    text += fmt::format("{}:  # that it was learnt from\n", kRecordings);
    for (const std::string& recording : angles.recordings) text += "  - " + in_yaml(recording) + "\n";
  }
  if (angles.elevation_correction_deg) {
    text += fmt::format("{}: {}  # that they were read with\n", kCorrection, *angles.elevation_correction_deg);
  }
  text += fmt::format("{}: {:.6f}  # to be added to all elevation angles: the estimate, if that is certain\n", kOffset,
                      kDegPerRad * angles.elevation_offset_rad);
  // Sweeps that say next to nothing may lead beyond what a file is believed.
  const bool believed = std::abs(kDegPerRad * angles.elevation_estimate.rad) <= kMostOffsetDeg;
  if (believed && std::isfinite(angles.elevation_estimate.sigma_rad)) {
    const double sigma_deg =
        std::clamp(kDegPerRad * angles.elevation_estimate.sigma_rad, kLeastSigmaDeg, kMostElevationDeg);
    text += fmt::format("{}: {:.6f}  # counts beside that of other recordings\n{}: {:.6f}\n", kEstimate,
                        kDegPerRad * angles.elevation_estimate.rad, kSigma, sigma_deg);
  }
  text += fmt::format(
      "{}:  # ring (without rings: range of elevation angles), its elevation, added to elevation and azimuth, deg\n",
      kBeamList);
  if (angles.beams.empty()) text += "  []\n";
  for (const BeamCorrection& beam : angles.beams) {
    text += fmt::format("  - [{}, {:.4f}, {:.6f}, {:.6f}]\n", beam.beam, kDegPerRad * beam.elevation_rad,
                        kDegPerRad * beam.add_elevation_rad, kDegPerRad * beam.add_azimuth_rad);
  }
  return text + fmt::format("{}  # without this line it is cut off\n", kEnd);
}

}  // namespace rilo
