#include "rilo/io/point_cloud2.hpp"

#include <array>
#include <optional>
#include <utility>

#include "io/clouds/cloud_columns.hpp"
#include "io/ros/message_cursor.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace detail {
namespace {

std::vector<PointField> take_fields(MessageCursor& cursor) {
  constexpr std::size_t kLeastFieldBytes = 13;  // an empty name, offset, datatype, count
  const std::size_t count = take_count(cursor, kLeastFieldBytes, "fields", "PointCloud2");
  std::vector<PointField> fields(count);
  for (PointField& field : fields) {
    field.name = cursor.take_string("field name");
    field.offset = cursor.take<std::uint32_t>("field offset");
    field.datatype = cursor.take<std::uint8_t>("field datatype");
    field.count = cursor.take<std::uint32_t>("field count");
  }
  return fields;
}

std::optional<ScalarType> scalar_type(std::uint8_t datatype) {
  constexpr std::array<ScalarType, 8> kTypes{ScalarType::kInt8,    ScalarType::kUint8,  ScalarType::kInt16,
                                             ScalarType::kUint16,  ScalarType::kInt32,  ScalarType::kUint32,
                                             ScalarType::kFloat32, ScalarType::kFloat64};
  if (datatype < 1 || datatype > kTypes.size()) return std::nullopt;
  return kTypes[datatype - 1U];
}

[[noreturn]] void reject(const BytesOrigin& origin, const std::string& found, const std::string& expected,
                         const char* remedy = "The driver wrote a wrong message: correct or record it again") {
  throw IoError({origin.file, origin.part, found, expected, remedy});
}

// The points without what pads the rows.
struct PointBytes {
  std::string_view in_message;
  std::string copy;  // used when the rows are padded
  std::size_t count = 0;

  const char* data() const { return copy.empty() ? in_message.data() : copy.data(); }
};

std::string shape_of(const PointCloud2& m) {
  return "width " + std::to_string(m.width) + ", height " + std::to_string(m.height) + ", point_step " +
         std::to_string(m.point_step) + ", row_step " + std::to_string(m.row_step) + " and " +
         counted(m.data.size(), "byte") + " of data";
}

PointBytes points_of(const PointCloud2& m, const BytesOrigin& origin) {
  PointBytes points;
  const std::uint64_t row_bytes = std::uint64_t{m.width} * m.point_step;
  std::uint64_t whole = 0;
  const bool too_much = __builtin_mul_overflow(row_bytes, std::uint64_t{m.height}, &whole);
  const std::uint64_t count = std::uint64_t{m.width} * m.height;
  if (count == 0) return points;
  if (m.point_step == 0) reject(origin, shape_of(m), "a point_step above 0");
  points.count = static_cast<std::size_t>(count);
  // Some drivers leave row_step unset: without padding it is not needed.
  if (!too_much && (m.height == 1 || m.row_step == row_bytes || whole == m.data.size()) && whole <= m.data.size()) {
    points.in_message = m.data.substr(0, static_cast<std::size_t>(whole));
    return points;
  }
  const std::uint64_t needed = std::uint64_t{m.row_step} * (m.height - 1) + row_bytes;
  if (too_much || m.row_step < row_bytes || needed > m.data.size()) {
    reject(origin, shape_of(m), "data for all points, in rows of at least width · point_step bytes");
  }
  points.copy.reserve(static_cast<std::size_t>(whole));
  for (std::uint64_t row = 0; row < m.height; ++row) {
    points.copy += m.data.substr(static_cast<std::size_t>(row * m.row_step), static_cast<std::size_t>(row_bytes));
  }
  return points;
}

void check_inside(const PointCloud2& m, const PointField& field, const BytesOrigin& origin) {
  const std::uint64_t end = std::uint64_t{field.offset} + size_of(*scalar_type(field.datatype));
  if (end <= m.point_step) return;
  reject(origin,
         "field " + in_quotes(field.name) + " at byte " + std::to_string(field.offset) + " to " + std::to_string(end) +
             " of a point",
         "an end within point_step " + std::to_string(m.point_step));
}

}  // namespace
}  // namespace detail

PointCloud2 parse_point_cloud2(std::string_view bytes, MessageEncoding encoding, const std::filesystem::path& file,
                               const std::string& part) {
  const detail::BytesOrigin origin{file, part};
  detail::MessageCursor cursor(bytes, encoding, origin);
  PointCloud2 message;
  detail::MessageHeaderFields header = detail::take_header(cursor);
  message.stamp_ns = header.stamp_ns;
  message.frame_id = std::move(header.frame_id);
  message.height = cursor.take<std::uint32_t>("height");
  message.width = cursor.take<std::uint32_t>("width");
  message.fields = detail::take_fields(cursor);
  message.is_bigendian = cursor.take<std::uint8_t>("is_bigendian") != 0;
  message.point_step = cursor.take<std::uint32_t>("point_step");
  message.row_step = cursor.take<std::uint32_t>("row_step");
  message.data = cursor.take_sequence("data");
  message.is_dense = cursor.take<std::uint8_t>("is_dense") != 0;
  return message;
}

RawCloud columns_of(const PointCloud2& message, const std::string& time_field, const std::filesystem::path& file,
                    const std::string& part) {
  const detail::BytesOrigin origin{file, part};
  if (message.is_bigendian) {
    detail::reject(origin, "is_bigendian true", "little-endian points",
                   "Convert the recording on the machine it is from");
  }
  const detail::PointBytes points = detail::points_of(message, origin);
  // Fields of an unknown type are ignored.
  std::vector<detail::Field> fields;
  std::vector<const PointField*> described;
  for (const PointField& field : message.fields) {
    const auto type = detail::scalar_type(field.datatype);
    if (!type) continue;
    fields.push_back({field.name, *type, field.count});
    described.push_back(&field);
  }
  const detail::FieldRoles roles = detail::find_roles(fields, time_field, origin);
  std::vector<detail::ColumnView> columns(fields.size());
  for (const std::size_t i : roles.all()) {
    if (points.count == 0) break;  // no address to add an offset to
    detail::check_inside(message, *described[i], origin);
    columns[i] = {points.data() + described[i]->offset, message.point_step, fields[i].type, false};
  }
  return detail::assemble_cloud(fields, roles, columns, points.count);
}

}  // namespace rilo
