// The paper's experiments on KITTI and M2DGR.
#pragma once

#include <filesystem>
#include <vector>

#include "bench/job.hpp"
#include "bench/tables.hpp"

namespace rilo {

/// ROOT/sequences/00 … 10, those that exist, each as recorded and with KITTI's elevation correction, both without
/// Rilo's own estimate of it; and as recorded with that estimate, if the configuration has it on.
/// @throws RunError, kBadData, when there is none.
std::vector<BenchJob> kitti_jobs(const std::filesystem::path& root, const BenchConfiguration& configuration);

/// Tables I and II (times), our columns beside the paper's.
std::vector<TitledTable> kitti_tables(const std::vector<BenchCell>& cells,
                                      MeasuredColumns measured = MeasuredColumns::kWith);

/// ROOT/NAME/ with sweeps, or ROOT/NAME.bag, and ROOT/NAME.txt with the true poses (TUM form), for every NAME that has
/// such poses or is in Table III. What cannot be read fails in its cell.
/// @throws RunError, kBadData, when there is none.
std::vector<BenchJob> m2dgr_jobs(const std::filesystem::path& root, const BenchConfiguration& configuration);

/// Table III.
std::vector<TitledTable> m2dgr_tables(const std::vector<BenchCell>& cells);

}  // namespace rilo
