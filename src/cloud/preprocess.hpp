// From a raw sweep to the two clouds the pipeline works on.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cloud/beam_angles.hpp"
#include "cloud/beam_index.hpp"
#include "cloud/beam_sample.hpp"
#include "cloud/elevation.hpp"
#include "cloud/thinning.hpp"
#include "cloud/timed_cloud.hpp"
#include "cloud/valid_points.hpp"
#include "cloud/voxel_mean.hpp"
#include "rilo/cloud/sweep.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// A sweep after range crop and downsampling; times relative to the middle of the sweep.
struct PreparedSweep {
  std::int64_t mid_stamp_ns = 0;  ///< reference time of the sweep's pose
  std::size_t valid_points = 0;   ///< finite, within range and no flakes
  std::size_t flakes = 0;         ///< isolated returns that were dropped
  TimedCloud map_cloud;           ///< one point per map voxel, the mean of its points
  TimedCloud source;              ///< S, one point per source voxel, the mean of its points
  BeamSample beam_sample;         ///< some of the points as measured; empty unless beams are tracked
  double median_range_m = 0;      ///< of S
  double scene_range_m = 0;       ///< the same, smoothed over the sweeps: how large the place is

  /// Of the finite points within range those that are no flakes, 0 … 1.
  double kept_share() const {
    return flakes == 0 ? 1.0 : static_cast<double>(valid_points) / static_cast<double>(valid_points + flakes);
  }
};

/// Range crop, removal of NaN and, when it snows, of flakes; time normalisation and downsampling. Keeps its buffers
/// from sweep to sweep.
class Preprocessor {
 public:
  static constexpr int kFirstPasses = 4;  ///< the first sweep is downsampled as often until its scale is found

  explicit Preprocessor(const PreprocessConfig& config)
      : config_(config), valid_(config), source_points_(static_cast<double>(config.source_points)) {}

  /// The result is valid until the next call.
  const PreparedSweep& prepare(const SweepView& sweep);

  /// Angle (rad) added to the elevation angle of every point from now on.
  void set_elevation_offset(double offset_rad) {
    elevation_turn_ = offset_rad != 0.0 ? std::optional(ElevationRotation(offset_rad)) : std::nullopt;
  }

  /// Angles added to those of single beams from now on.
  void set_beam_angles(const BeamAngles& angles) { beam_angles_ = angles; }

  /// Whether to find out which beam each point came from: fills the sample, and corrects the angles of single beams.
  void track_beams(bool tracked) { beams_tracked_ = tracked; }

  /// Whether the clouds carry the intensities of sweeps that have them.
  void keep_intensities(bool kept) { intensities_kept_ = kept; }

  /// How many points the source cloud should have from the next sweep on, instead of config.source_points.
  void set_source_points(double points);

  /// Leaves a share (0 … 1) of the points of both clouds of the sweep prepared last.
  void thin(double share) {
    prepared_.source = thinned(prepared_.source, share);
    prepared_.map_cloud = thinned(prepared_.map_cloud, share);
  }

  void reset();

 private:
  void crop(const SweepView& sweep);
  void crop_chunk(const SweepView& sweep, float mid_s, std::size_t first, std::size_t last, std::size_t to);
  void sample_beams();
  void downsample(double source_voxel_m);
  void adapt_voxel(double most_growth);
  void update_scene_range();

  PreprocessConfig config_;
  ValidPoints valid_;
  TimedCloud cropped_;
  PreparedSweep prepared_;
  std::vector<float> ranges_;
  VoxelMean map_mean_;
  VoxelMean source_mean_;
  double source_points_;       // aimed for
  double source_voxel_m_ = 0;  // 0: no sweep has been seen
  std::optional<ElevationRotation> elevation_turn_;
  bool beams_tracked_ = false;
  bool intensities_kept_ = false;
  BeamIndex beam_index_;
  BeamAngles beam_angles_;
  std::vector<Beam> beams_;          // of the points of the sweep
  std::vector<Beam> cropped_beams_;  // of those of cropped_
  std::size_t sample_phase_ = 0;
};

}  // namespace rilo
