// Figures of other programs on the sequences of a benchmark, from a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/store.hpp"

namespace rilo {

/// A row a sequence and peer: columns `drive`, `peer`, `t_rel_pct`, and any of those of results.csv; also
/// `r_rel_deg_100m`, `mean_ms`, `median_ms`, `pose_instant`. Others are passed over. A figure that is empty or nan is
/// none. @throws IoError with line and column: no such columns, no number, a peer twice on a drive.
std::vector<BenchCell> read_peer_figures(const std::filesystem::path& file);

/// Puts those of `figures` that belong to `sequence` behind the peers in `cells`. A peer that has poses there keeps
/// what they say, and gets the times that are in the file. The figures are of whole drives: where a part was run, not
/// `whole`, the times alone count.
void add_peer_figures(const std::vector<BenchCell>& figures, const std::string& sequence, bool whole,
                      std::vector<StoredCell>& cells);

}  // namespace rilo
