#include "io/clouds/cloud_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "io/raw_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

struct TypeRow {
  ScalarType type;
  std::size_t bytes;
  std::string_view name;
};
constexpr std::array<TypeRow, 10> kScalarRows{{{ScalarType::kInt8, 1, "int8"},
                                               {ScalarType::kUint8, 1, "uint8"},
                                               {ScalarType::kInt16, 2, "int16"},
                                               {ScalarType::kUint16, 2, "uint16"},
                                               {ScalarType::kInt32, 4, "int32"},
                                               {ScalarType::kUint32, 4, "uint32"},
                                               {ScalarType::kInt64, 8, "int64"},
                                               {ScalarType::kUint64, 8, "uint64"},
                                               {ScalarType::kFloat32, 4, "float32"},
                                               {ScalarType::kFloat64, 8, "float64"}}};

}  // namespace

std::size_t size_of(ScalarType type) { return kScalarRows[static_cast<std::size_t>(type)].bytes; }
std::string_view to_string(ScalarType type) { return kScalarRows[static_cast<std::size_t>(type)].name; }
bool is_floating(ScalarType type) { return type == ScalarType::kFloat32 || type == ScalarType::kFloat64; }

namespace detail {
namespace {

// Calls `function` with a value of the C++ type of `type`.
template <typename Function>
auto with_type(ScalarType type, Function&& function) {
  switch (type) {
    case ScalarType::kInt8:
      return function(std::int8_t{});
    case ScalarType::kUint8:
      return function(std::uint8_t{});
    case ScalarType::kInt16:
      return function(std::int16_t{});
    case ScalarType::kUint16:
      return function(std::uint16_t{});
    case ScalarType::kInt32:
      return function(std::int32_t{});
    case ScalarType::kUint32:
      return function(std::uint32_t{});
    case ScalarType::kInt64:
      return function(std::int64_t{});
    case ScalarType::kUint64:
      return function(std::uint64_t{});
    case ScalarType::kFloat32:
      return function(float{});
    case ScalarType::kFloat64:
      break;
  }
  return function(double{});
}

template <typename Visit>
void for_each_value(const ColumnView& column, std::size_t count, Visit&& visit) {
  with_type(column.type, [&](auto example) {
    const char* from = column.data;
    for (std::size_t i = 0; i < count; ++i, from += column.stride) {
      visit(i, load_bytes<decltype(example)>({from, sizeof(example)}, 0, column.big_endian));
    }
  });
}

// Out of range and NaN saturate: the ring is only a label.
template <typename T>
std::uint16_t to_ring(T value) {
  constexpr double kLargest = std::numeric_limits<std::uint16_t>::max();
  const double ring = std::round(static_cast<double>(value));
  return ring >= 0 && ring <= kLargest ? static_cast<std::uint16_t>(ring) : static_cast<std::uint16_t>(kLargest);
}

template <typename T>
std::int64_t to_int64(T value) {
  constexpr auto kLargest = std::numeric_limits<std::int64_t>::max();
  if constexpr (std::is_same_v<T, std::uint64_t>) {
    return value > static_cast<std::uint64_t>(kLargest) ? kLargest : static_cast<std::int64_t>(value);
  } else {
    return static_cast<std::int64_t>(value);
  }
}

RawTimes read_times(const Field& field, const ColumnView& column, std::size_t count) {
  RawTimes times;
  times.field = field.name;
  times.type = field.type;
  if (is_floating(field.type)) {
    times.floats.resize(count);
    read_column(column, times.floats);
  } else {
    times.integers.resize(count);
    for_each_value(column, count, [&](std::size_t i, auto value) { times.integers[i] = to_int64(value); });
  }
  return times;
}

std::string plain_name(const std::string& name) {
  constexpr std::string_view kPrefix = "scalar_";
  const std::string lower = lower_case(name);
  return lower.rfind(kPrefix, 0) == 0 ? lower.substr(kPrefix.size()) : lower;
}

// The first of `names` that is there.
std::optional<std::size_t> find_name(const std::vector<std::string>& fields,
                                     std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const auto found = std::find(fields.begin(), fields.end(), name);
    if (found != fields.end()) return static_cast<std::size_t>(found - fields.begin());
  }
  return std::nullopt;
}

std::string list_of(const std::vector<Field>& fields) {
  std::string text;
  for (const Field& field : fields) text += (text.empty() ? "" : " ") + field.name;
  return text.empty() ? "no fields" : "the fields " + in_quotes(text);
}

std::size_t need(const std::vector<Field>& fields, const std::vector<std::string>& names, std::string_view name,
                 const BytesOrigin& origin) {
  if (const auto place = find_name(names, {name})) return *place;
  throw IoError({origin.file, origin.part, list_of(fields), "x, y and z among them",
                 "Write the points with fields named x, y and z"});
}

// "5", and "5.000000" as numpy.savetxt writes it.
std::optional<std::int64_t> parse_whole(std::string_view text) {
  if (const auto number = parse_integer(text)) return number;
  constexpr double kLargest = 9e15;  // beyond it not every whole number is a double
  const auto number = parse_double(text);
  const bool whole = number && std::trunc(*number) == *number && std::abs(*number) <= kLargest;
  return whole ? std::optional(static_cast<std::int64_t>(*number)) : std::nullopt;
}

// time_offset, gps_time, timestamp_ns, ts: their values are not looked at, so that they are a hint and no more.
bool sounds_like_times(const std::string& name) {
  const std::string plain = plain_name(name);
  return plain == "ts" || plain.find("time") != std::string::npos || plain.find("stamp") != std::string::npos;
}

}  // namespace

std::vector<std::size_t> FieldRoles::all() const {
  std::vector<std::size_t> indices{x, y, z};
  for (const auto& role : {intensity, time, ring}) {
    if (role) indices.push_back(*role);
  }
  return indices;
}

FieldRoles find_roles(const std::vector<Field>& fields, const std::string& time_field, const BytesOrigin& origin) {
  std::vector<std::string> names;
  names.reserve(fields.size());
  for (const Field& field : fields) names.push_back(plain_name(field.name));
  FieldRoles roles;
  roles.x = need(fields, names, "x", origin);
  roles.y = need(fields, names, "y", origin);
  roles.z = need(fields, names, "z", origin);
  roles.intensity = find_name(names, {"intensity", "i", "reflectivity", "remission", "reflectance"});
  roles.ring = find_name(names, {"ring", "channel", "line", "laser_id"});
  if (!time_field.empty()) {
    roles.time = find_name(names, {plain_name(time_field)});
    if (!roles.time) {
      throw IoError({origin.file, origin.part, list_of(fields), "the time field " + in_quotes(time_field),
                     "Set time_field (--time-field) to one of these, or leave it out"});
    }
    return roles;
  }
  roles.time = find_name(names, {"offset_time", "t", "time", "timestamp", "time_stamp"});
  // s and t beside each other are texture coordinates.
  const bool texture = roles.time && names[*roles.time] == "t" && find_name(names, {"s"});
  if (texture) roles.time.reset();
  return roles;
}

std::vector<FieldInfo> describe_fields(const std::vector<Field>& fields, const FieldRoles& roles) {
  std::vector<FieldInfo> described;
  for (const Field& field : fields)
    described.push_back({field.name, false, !roles.time && sounds_like_times(field.name)});
  for (const std::size_t index : roles.all()) described[index] = {fields[index].name, true, false};
  return described;
}

double read_value(const ColumnView& column) {
  double first = 0;
  for_each_value(column, 1, [&](std::size_t /*i*/, auto value) { first = static_cast<double>(value); });
  return first;
}

void read_column(const ColumnView& column, std::vector<double>& values) {
  for_each_value(column, values.size(), [&](std::size_t i, auto value) { values[i] = static_cast<double>(value); });
}

RawCloud assemble_cloud(const std::vector<Field>& fields, const FieldRoles& roles,
                        const std::vector<ColumnView>& columns, std::size_t count) {
  RawCloud cloud;
  cloud.points.resize(count);
  const std::array<std::size_t, 3> axes{roles.x, roles.y, roles.z};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    for_each_value(columns[axes[axis]], count, [&](std::size_t i, auto value) {
      cloud.points[i][static_cast<Eigen::Index>(axis)] = static_cast<float>(value);
    });
  }
  if (roles.intensity) {
    cloud.intensities.resize(count);
    for_each_value(columns[*roles.intensity], count,
                   [&](std::size_t i, auto value) { cloud.intensities[i] = static_cast<float>(value); });
  }
  if (roles.ring) {
    cloud.rings.resize(count);
    for_each_value(columns[*roles.ring], count, [&](std::size_t i, auto value) { cloud.rings[i] = to_ring(value); });
  }
  if (roles.time) cloud.times = read_times(fields[*roles.time], columns[*roles.time], count);
  return cloud;
}

PackedRows::PackedRows(const std::vector<Field>& fields, const FieldRoles& roles) : offsets_(fields.size()) {
  for (const Field& field : fields) types_.push_back(field.type);
  for (const std::size_t index : roles.all()) {
    offsets_[index] = stride_;
    stride_ += size_of(types_[index]);
  }
}

bool PackedRows::store_text(std::size_t field, std::string_view text) {
  return with_type(types_[field], [&](auto value) {
    using T = decltype(value);
    if constexpr (std::is_floating_point_v<T>) {
      const auto number = parse_double(text);
      if (!number) return false;
      value = static_cast<T>(*number);
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      const auto number = parse_unsigned(text);
      if (!number) return false;
      value = *number;
    } else {
      const auto number = parse_whole(text);
      if (!number || *number < std::numeric_limits<T>::min() || *number > std::numeric_limits<T>::max()) return false;
      value = static_cast<T>(*number);
    }
    std::memcpy(last_row() + *offsets_[field], &value, sizeof(T));
    return true;
  });
}

void PackedRows::store_bytes(std::size_t field, const char* value) {
  std::memcpy(last_row() + *offsets_[field], value, size_of(types_[field]));
}

std::vector<ColumnView> PackedRows::columns(bool big_endian) const {
  std::vector<ColumnView> columns(offsets_.size());
  if (bytes_.empty()) return columns;  // no address to add an offset to
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (offsets_[i]) columns[i] = {bytes_.data() + *offsets_[i], stride_, types_[i], big_endian};
  }
  return columns;
}

}  // namespace detail
}  // namespace rilo
