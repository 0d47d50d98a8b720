#include "rilo/odometry/odometry.hpp"

#include <utility>

#include "odometry/pipeline.hpp"

namespace rilo {

class Odometry::Impl : public Pipeline {
 public:
  using Pipeline::Pipeline;
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

double Odometry::start_over() { return impl_->start_over(); }

}  // namespace rilo
