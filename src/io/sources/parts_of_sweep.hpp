// How many messages or files of a sensor make up one sweep.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rilo/cloud/sweep.hpp"

namespace rilo::detail {

/// Drivers may send the parts of a sweep one by one: sectors of a turn, or what a rosette sees in a fiftieth of a
/// second. Neighbouring sectors see different surroundings, and a few hundred points are no sweep. A whole sweep is
/// known by its directions, which the next one has again.
class PartsOfSweep {
 public:
  /// Of data that come every `period_s`.
  explicit PartsOfSweep(double period_s);

  /// The next one of the data, from the first on.
  void add(const Sweep& sweep);

  /// Known after so many of them: one, when they come every 75 ms or are farther apart; as many as come before the
  /// directions of the first are seen again; where none within 0.25 s does, as with a rosette, those of 0.1 s.
  std::optional<std::size_t> parts() const { return parts_; }

 private:
  double period_s_;
  std::optional<std::size_t> parts_;
  std::size_t added_ = 0;
  std::vector<bool> first_;  // directions of the first one, as cells of azimuth and elevation
};

}  // namespace rilo::detail
