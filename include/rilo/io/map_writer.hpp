// Maps to .ply or .pcd, streamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "rilo/cloud/thinned_map.hpp"

namespace rilo {

class AtomicFile;

/// Columns of a map besides the coordinates.
struct MapColumns {
  bool normals = false;
  bool intensity = false;
};

/// Writes points as they come; the count in the header is filled in by finish(). The extension decides: .ply (binary
/// little endian) or .pcd (binary). Without finish() no file appears.
class MapWriter {
 public:
  /// @throws IoError: unknown extension, folder not writable.
  explicit MapWriter(const std::filesystem::path& file, MapColumns columns = {});
  ~MapWriter();

  /// Appends points (m). @throws std::invalid_argument when a column of the map is not as long as `points`, or one that
  /// the map has not is not empty.
  void add(const MapCloud& part);

  /// Completes the header and puts the file in place.
  void finish();

  std::uint64_t count() const { return count_; }

 private:
  std::string header() const;

  bool ply_;
  MapColumns columns_;
  std::unique_ptr<AtomicFile> file_;
  std::uint64_t count_ = 0;
};

/// The whole map in one call, with the columns that it has.
void write_map(const std::filesystem::path& file, const MapCloud& map);

}  // namespace rilo
