// From the fields of a cloud file, however they lie in memory, to the columns that we use.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// What to do with a file whose body does not fit its header.
inline constexpr const char* kCutOff =
    "The file is cut off or its header is wrong: copy or write it again, or leave it out with --skip-bad-sweeps";

/// One field of a record. A field with a count above 1 is an array; we use its first element.
struct Field {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::size_t count = 1;

  std::size_t bytes() const { return size_of(type) * count; }
};

/// The columns of a .bin record, see SourceOptions::bin_fields. @throws std::invalid_argument when `text` makes no
/// sense.
std::vector<Field> parse_bin_fields(const std::string& text);

/// For bin_fields "auto": x,y,z,intensity, or with a ring behind when the sizes of the files, or the numbers in them,
/// fit nothing else and the fifth column has numbers of beams, or when they are named as nuScenes does (NAME.pcd.bin).
/// @throws IoError when the sizes fit x,y,z,intensity, but the numbers are those of records of another length.
std::string guess_bin_fields(const std::vector<std::filesystem::path>& files);

/// A sentence where the numbers of the file are those of records of another length than `columns`, else empty.
std::string doubt_about_columns(const std::filesystem::path& file, std::size_t columns);

/// "3, 5": how many columns of float32 the records of a file of that size may have.
std::string fitting_columns(std::size_t bytes);

/// Which field is what; indices into the list of fields.
struct FieldRoles {
  std::size_t x = 0;
  std::size_t y = 0;
  std::size_t z = 0;
  std::optional<std::size_t> intensity;
  std::optional<std::size_t> time;
  std::optional<std::size_t> ring;

  /// All indices that are set.
  std::vector<std::size_t> all() const;
};

/// Finds the roles by the usual names, whatever their case; CloudCompare's prefix "scalar_" is ignored.
/// @throws IoError when x, y or z is missing, or the time field that was asked for.
FieldRoles find_roles(const std::vector<Field>& fields, const std::string& time_field, const BytesOrigin& origin);

/// For SourceInfo::fields.
std::vector<FieldInfo> describe_fields(const std::vector<Field>& fields, const FieldRoles& roles);

/// One column: value i is at data + i * stride.
struct ColumnView {
  const char* data = nullptr;
  std::size_t stride = 0;
  ScalarType type = ScalarType::kFloat32;
  bool big_endian = false;
};

/// The first value of a column.
double read_value(const ColumnView& column);
/// All values of a column; `values` has the length.
void read_column(const ColumnView& column, std::vector<double>& values);

/// Reads the columns that have a role. `columns` is as long as `fields`; those without a role are not looked at.
RawCloud assemble_cloud(const std::vector<Field>& fields, const FieldRoles& roles,
                        const std::vector<ColumnView>& columns, std::size_t count);

/// Rows that cannot be looked at in place (text, rows of varying length): only the fields with a role, packed.
class PackedRows {
 public:
  PackedRows(const std::vector<Field>& fields, const FieldRoles& roles);

  bool wanted(std::size_t field) const { return offsets_[field].has_value(); }

  /// Grows by one row of zeros.
  void add_row() { bytes_.resize(bytes_.size() + stride_); }

  /// Parses a number into `field` of the last row; false when it is not a number of the field's type.
  bool store_text(std::size_t field, std::string_view text);

  /// Copies a binary value into `field` of the last row.
  void store_bytes(std::size_t field, const char* value);

  std::vector<ColumnView> columns(bool big_endian) const;

 private:
  char* last_row() { return bytes_.data() + bytes_.size() - stride_; }

  std::vector<ScalarType> types_;
  std::vector<std::optional<std::size_t>> offsets_;
  std::size_t stride_ = 0;
  std::vector<char> bytes_;
};

}  // namespace rilo::detail
