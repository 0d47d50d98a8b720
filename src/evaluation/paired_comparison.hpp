// Two odometries on the same drives: figures of one over those of the other.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace rilo {

/// An error of one drive, by both; smaller is better. Nothing: there was no result.
struct PairedFigure {
  std::string drive;
  std::optional<double> ours;
  std::optional<double> theirs;
};

/// How ours compare with theirs, drive by drive.
struct PairedComparison {
  std::size_t drives = 0;
  std::optional<double> mean_ratio;      ///< geometric mean of ours / theirs, over the drives that neither lost
  std::optional<double> mean_ratio_all;  ///< the same over all drives on which both have a figure
  std::optional<double> worst_ratio;     ///< of these
  std::string worst_drive;
  std::size_t ahead = 0;   ///< ours is less, or theirs alone is lost
  std::size_t behind = 0;  ///< the reverse; equal figures and drives lost by both are neither
  double sign_test_p = 1;  ///< of ahead and behind
  std::vector<std::string> lost_by_us;
  std::vector<std::string> lost_by_them;
};

/// A drive without a figure, or with one above `lost_above`, is lost. Figures that are not positive have no ratio.
PairedComparison compare_pairs(const std::vector<PairedFigure>& pairs, double lost_above);

/// Two-sided exact sign test: how likely so uneven an outcome is where both are as likely to be ahead.
double sign_test_p(std::size_t ahead, std::size_t behind);

}  // namespace rilo
