// Estimate of a constant error of the sensor's elevation angles, δ, over the sweeps of a recording.
#pragma once

#include <array>
#include <cstddef>

#include "calibration/elevation_information.hpp"
#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// δ over all sweeps so far.
class ElevationOffsetEstimator {
 public:
  explicit ElevationOffsetEstimator(const ElevationOffsetConfig& config);

  /// Adds a sweep that was registered with `applied_rad()` added to its elevation angles.
  void add(const ElevationInformation& sweep);

  /// Estimate of the angle to add to the sensor's elevation angles, and its standard deviation: of the sweeps and of
  /// other recordings, unless the sweeps contradict, or of what sensors usually have. The applied angle and infinite
  /// before there are enough sweeps.
  AngleEstimate estimate() const;
  /// Angle added so far.
  double applied_rad() const { return applied_rad_; }

  /// Lets the applied angle follow the estimate where that differs significantly from zero or from the configured
  /// angle, else takes it back to the latter. Returns the change of the applied angle.
  double advance();

  /// The angle to begin with in another run: the estimate if that is certain, else the one that this run began with.
  double known_deg() const;

  /// Forgets the sweeps; `initial_deg` is applied from now on, in place of the configured angle. `others`: what other
  /// recordings say.
  void begin_with(double initial_deg, const AngleEstimate& others);

  /// What begin_with() was told, unless the sweeps contradict.
  const AngleEstimate& others() const { return others_; }

 private:
  double initial_rad() const;
  AngleEstimate of_sweeps() const;
  double sigma_of_sweeps_rad() const;
  AngleEstimate beside_what_is_known(const AngleEstimate& own) const;
  void doubt_others(const AngleEstimate& own);

  ElevationOffsetConfig config_;
  AngleEstimate others_;
  double applied_rad_ = 0;
  bool following_ = false;
  std::size_t sweeps_ = 0;
  double information_ = 0;
  double weighted_offset_ = 0;
  std::array<double, kBands> by_band_ = {};
  // Sums over finished blocks: information, its product with the offset and with its square.
  std::size_t blocks_ = 0;
  double jacobian2_ = 0;
  double block_information_ = 0;
  double block_offset_ = 0;
  double squares_ = 0;
  double squared_information_ = 0;
  std::size_t in_block_ = 0;
};

}  // namespace rilo
