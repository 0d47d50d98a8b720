// Records of float32: KITTI's and nuScenes' .bin.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "io/clouds/cloud_columns.hpp"
#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace detail {
namespace {

constexpr std::array<std::string_view, 12> kKnown{"x", "y", "z",           "intensity", "i",          "time",
                                                  "t", "_", "offset_time", "timestamp", "time_stamp", "ring"};

[[noreturn]] void reject(const std::string& fields, const std::string& why) {
  throw std::invalid_argument("bin_fields " + in_quotes(fields) + ": " + why +
                              "; give the columns of a record in order, for example x,y,z,intensity,time,ring, with _ "
                              "for a column to ignore");
}

}  // namespace

std::vector<Field> parse_bin_fields(const std::string& text) {
  std::vector<Field> fields;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = lower_case(trimmed(std::string_view(text).substr(begin, end - begin)));
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end())
      reject(text, "unknown column " + in_quotes(name));
    const auto same = [&](const Field& field) { return field.name == name; };
    if (name != "_" && std::any_of(fields.begin(), fields.end(), same)) reject(text, in_quotes(name) + " twice");
    fields.push_back({name, ScalarType::kFloat32, 1});
    begin = end + 1;
  }
  for (const char* axis : {"x", "y", "z"}) {
    const auto same = [&](const Field& field) { return field.name == axis; };
    if (std::none_of(fields.begin(), fields.end(), same)) reject(text, std::string("no column ") + axis);
  }
  return fields;
}

namespace {

std::string size_hint(std::size_t bytes) {
  const std::string fitting = fitting_columns(bytes);
  return fitting.empty() ? "" : " (the size would fit records of " + fitting + " columns)";
}

void check_size(const FileBytes& bytes, const std::string& fields, std::size_t columns) {
  const std::size_t record = columns * sizeof(float);
  const std::size_t rest = bytes.size % record;
  if (rest == 0) return;
  throw IoError({bytes.path, "byte " + std::to_string(bytes.size - rest),
                 counted(bytes.size, "byte") + ", which is " + counted(bytes.size / record, "record") + " and " +
                     counted(rest, "byte"),
                 "records of " + counted(record, "byte") + " (" + fields + ", float32 each)",
                 "The file is cut off, or bin_fields (--bin-fields) does not fit it" + size_hint(bytes.size)});
}

// A wrong column count or another number format shows in absurd coordinates. Infinite ones are no returns, as NaN.
void check_plausible(const std::filesystem::path& file, const std::string& fields, const RawCloud& cloud) {
  constexpr float kFarthest = 1e6F;
  const auto absurd =
      static_cast<std::size_t>(std::count_if(cloud.points.begin(), cloud.points.end(), [](const Eigen::Vector3f& p) {
        return p.allFinite() && p.cwiseAbs().maxCoeff() > kFarthest;
      }));
  if (absurd * 10 <= cloud.points.size()) return;
  throw IoError(
      {file, "",
       std::to_string(absurd) + " of " + std::to_string(cloud.points.size()) + " points are farther than 1000 km",
       "float32 records of " + fields,
       "Set bin_fields (--bin-fields) to the columns that the file has; convert it if its numbers are not float32"});
}

}  // namespace
}  // namespace detail

RawCloud read_bin(const std::filesystem::path& file, const std::string& fields) {
  const std::vector<detail::Field> columns = detail::parse_bin_fields(fields);
  const detail::FileBytes bytes = detail::read_file(file);
  detail::check_size(bytes, fields, columns.size());
  const std::size_t record = columns.size() * sizeof(float);
  std::vector<detail::ColumnView> views;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    views.push_back({bytes.data.get() + i * sizeof(float), record, ScalarType::kFloat32, false});
  }
  RawCloud cloud = detail::assemble_cloud(columns, detail::find_roles(columns, "", {file}), views, bytes.size / record);
  detail::check_plausible(file, fields, cloud);
  return cloud;
}

}  // namespace rilo
