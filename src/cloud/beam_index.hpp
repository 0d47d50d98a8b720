// Which beam a point came from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rilo/cloud/sweep.hpp"

namespace rilo {

/// Index of a point's beam, or of a narrow range of elevation angles.
using Beam = std::uint16_t;

inline constexpr Beam kNoBeam = 0xFFFF;
inline constexpr std::size_t kBeams = 1024;  ///< indices are below

/// Fills `beams` with one index per point, kNoBeam where there is none: the sweep's rings where it has them. Otherwise
/// an index is a narrow range of elevation angles: of a whole revolution when the points lie beam by beam (as in
/// KITTI's files, where motion compensation has blurred the angles of single points), of each point when they do not.
class BeamIndex {
 public:
  void assign(const SweepView& sweep, std::vector<Beam>& beams);

 private:
  struct Revolution {
    std::size_t first = 0;  // its first point
    std::size_t count = 0;
    double sum = 0;  // of the tangents of the elevation angles of its points
    double squares = 0;
  };
  float find_tangents(std::span<const Eigen::Vector3f> points);
  bool find_revolutions(std::span<const Eigen::Vector3f> points, float direction);
  void find_borders(std::span<const Eigen::Vector3f> points, std::size_t begin, float direction);
  std::size_t end_of(std::size_t t) const {
    return t + 1 < revolutions_.size() ? revolutions_[t + 1].first : tangents_.size();
  }
  bool revolutions_are_beams() const;

  std::vector<Revolution> revolutions_;
  std::vector<float> tangents_;
  std::vector<std::ptrdiff_t> forward_;  // of each chunk: steps in the sense of the azimuth less those against it
};

}  // namespace rilo
