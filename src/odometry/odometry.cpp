#include "rilo/odometry/odometry.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "calibration/same_sensor.hpp"
#include "odometry/pipeline.hpp"

namespace rilo {

class Odometry::Impl : public Pipeline {
 public:
  using Pipeline::Pipeline;

  SweepResult register_sweep(const SweepView& sweep) {
    check_sensor(sweep);
    return Pipeline::register_sweep(sweep);
  }

  void reset() { Pipeline::reset(known_); }

  SensorAngles sensor_angles() const {
    SensorAngles angles = Pipeline::sensor_angles();
    if (known_) {
      angles.elevation_correction_deg = known_->elevation_correction_deg;
      angles.recordings = known_->recordings;
    }
    return angles;
  }

  void start_with(const SensorAngles& known) {
    known_ = known;
    checked_ = false;
    reset();
  }

 private:
  // The known angles are of one unit: on the points of another sensor they would do harm that nothing shows.
  void check_sensor(const SweepView& sweep) {
    if (!known_ || checked_) return;
    const std::optional<std::string> difference = other_sensor(*known_, sweep);
    if (!difference) return;
    if (!difference->empty()) {
      throw std::invalid_argument(name_of(*known_) +
                                  ": of another sensor, or of data read in another way: " + *difference +
                                  "; expected one that was learnt from this sensor. A run without it leaves one");
    }
    checked_ = true;
  }

  std::optional<SensorAngles> known_;
  bool checked_ = false;
};

Odometry::Odometry(const OdometryConfig& config, Clock clock)
    : impl_(std::make_unique<Impl>(config, std::move(clock))) {}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

SweepResult Odometry::register_sweep(const SweepView& sweep) { return impl_->register_sweep(sweep); }

const Trajectory& Odometry::trajectory() const { return impl_->trajectory(); }

std::vector<Eigen::Vector3f> Odometry::local_map() const { return impl_->map().map().points(); }

const std::vector<Eigen::Vector3f>& Odometry::last_map_points() const { return impl_->map().last_points(); }

void Odometry::keep_intensities(bool kept) { impl_->keep_intensities(kept); }

const std::vector<float>& Odometry::last_map_intensities() const { return impl_->map().last_intensities(); }

void Odometry::reset() { impl_->reset(); }

void Odometry::start_with(const SensorAngles& known) { impl_->start_with(known); }

SensorAngles Odometry::sensor_angles() const { return impl_->sensor_angles(); }

double Odometry::start_over(const std::optional<KnownVelocity>& velocity) { return impl_->start_over(velocity); }

}  // namespace rilo
