// Maps to .ply or .pcd, streamed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "rilo/io/atomic_file.hpp"

namespace rilo {

/// Writes points as they come; the count in the header is filled in by finish(). The extension decides: .ply (binary
/// little endian) or .pcd (binary). Without finish() no file appears.
class MapWriter {
 public:
  /// @throws IoError: unknown extension, folder not writable.
  explicit MapWriter(const std::filesystem::path& file, bool with_intensity = false);

  /// Appends points (m). `intensities` is as long as `points` when the map has intensity, else empty.
  /// @throws std::invalid_argument when it is not.
  void add(std::span<const Eigen::Vector3f> points, std::span<const float> intensities = {});

  /// Completes the header and puts the file in place.
  void finish();

  std::uint64_t count() const { return count_; }

 private:
  std::string header() const;

  bool ply_;
  bool with_intensity_;
  AtomicFile file_;
  std::uint64_t count_ = 0;
};

/// The whole map in one call.
void write_map(const std::filesystem::path& file, const std::vector<Eigen::Vector3f>& points,
               const std::vector<float>& intensities = {});

}  // namespace rilo
