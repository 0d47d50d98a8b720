// Recognises a sweep that is repeated.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cloud/measured_point.hpp"

namespace rilo {

/// Number of points and some of those that were measured: those of another sweep never have the same bits. Without any
/// nothing is said, and no other is equal.
class Fingerprint {
 public:
  Fingerprint() = default;
  explicit Fingerprint(std::span<const Eigen::Vector3f> points) : size_(points.size()) {
    for (std::size_t i = 0; i < points.size(); i += kStride) {
      if (detail::is_measured(points[i])) {
        sample_.push_back(points[i]);
      }
    }
  }

  bool operator==(const Fingerprint& other) const {
    return size_ == other.size_ && sample_.size() == other.sample_.size() && !sample_.empty() &&
           std::memcmp(sample_.data(), other.sample_.data(), sample_.size() * sizeof(sample_[0])) == 0;
  }

 private:
  // A sample suffices: two sweeps of a sensor share hardly a point. A prime: any other may meet the same beam again and
  // again.
  static constexpr std::size_t kStride = 31;
  std::size_t size_ = 0;
  std::vector<Eigen::Vector3f> sample_;
};

}  // namespace rilo
