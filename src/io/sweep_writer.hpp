// Sweeps to files: for the simulator, for conversion and for tests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "rilo/cloud/sweep.hpp"

namespace rilo {

enum class PcdEncoding : std::uint8_t { kAscii, kBinary, kBinaryCompressed };
enum class PlyEncoding : std::uint8_t { kAscii, kBinaryLittleEndian, kBinaryBigEndian };

/// float32 x y z intensity (0 when the sweep has none), KITTI's velodyne/*.bin. Times and rings are not kept.
void write_kitti_bin(const std::filesystem::path& file, const Sweep& sweep);

/// float32 values one after the other: the drive simulator's times_pt/*.bin.
void write_floats(const std::filesystem::path& file, const std::vector<float>& values);

/// x y z and, where the sweep has them, intensity (float32), time (float32, s since the stamp), ring (uint16).
void write_pcd(const std::filesystem::path& file, const Sweep& sweep, PcdEncoding encoding = PcdEncoding::kBinary);
void write_ply(const std::filesystem::path& file, const Sweep& sweep,
               PlyEncoding encoding = PlyEncoding::kBinaryLittleEndian);

}  // namespace rilo
