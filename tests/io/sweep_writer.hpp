// Sweeps to files of every form that the readers take.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/clouds/pcd_header.hpp"
#include "io/clouds/ply_header.hpp"
#include "rilo/cloud/sweep.hpp"

namespace rilo {

using detail::PcdEncoding;
using detail::PlyEncoding;

/// float32 x y z intensity (0 when the sweep has none), KITTI's velodyne/*.bin. Times and rings are not kept.
void write_kitti_bin(const std::filesystem::path& file, const Sweep& sweep);

/// float32 values one after the other: the drive simulator's times_pt/*.bin.
void write_floats(const std::filesystem::path& file, const std::vector<float>& values);

/// x y z and, where the sweep has them, intensity (float32), time (float32, s since the stamp), ring (uint16).
void write_pcd(const std::filesystem::path& file, const Sweep& sweep, PcdEncoding encoding = PcdEncoding::kBinary);
void write_ply(const std::filesystem::path& file, const Sweep& sweep,
               PlyEncoding encoding = PlyEncoding::kBinaryLittleEndian);

/// LZF, as binary_compressed has it; incompressible input grows by 1/32.
std::string lzf_compress(std::string_view input);

}  // namespace rilo
