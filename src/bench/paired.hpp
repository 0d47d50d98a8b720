// Configurations beside the peers, drive by drive: ratios of t_rel and what they say together.
#pragma once

#include <string>
#include <vector>

#include "bench/tables.hpp"
#include "evaluation/paired_comparison.hpp"

namespace rilo {

/// A drive with a larger t_rel, or without one, is lost. One on which the peer failed, as its poses could not be read,
/// is not compared.
constexpr double kLostAbovePct = 10;

/// Stands for the peer with the least t_rel on each drive.
constexpr const char* kBestPeer = "best peer";

/// A configuration against a peer on the sequences of one group.
struct BenchComparison {
  std::string configuration;
  std::string peer;
  std::string group;  ///< "all": every sequence
  PairedComparison result;
};

/// Every configuration against the best peer and each peer, over all sequences that the peer was given on, then over
/// each group. Nothing without peers.
std::vector<BenchComparison> bench_comparisons(const std::vector<BenchCell>& cells);

/// The comparisons with the drives that are lost, and the ratio to the best peer of each sequence. Empty without peers.
std::vector<TitledTable> paired_tables(const std::vector<BenchCell>& cells);

/// paired.csv: one row per comparison, without loss.
TextTable paired_csv(const std::vector<BenchCell>& cells);

}  // namespace rilo
