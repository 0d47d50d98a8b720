// Recognises a sweep that is repeated.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace rilo {

/// Number of points and some of them: those of another sweep never have the same bits.
class Fingerprint {
 public:
  Fingerprint() = default;
  explicit Fingerprint(std::span<const Eigen::Vector3f> points) : size_(points.size()) {
    for (std::size_t i = 0; i < points.size(); i += kStride) {
      sample_.push_back(points[i]);
    }
  }

  bool operator==(const Fingerprint& other) const {
    return size_ == other.size_ &&
           (size_ == 0 || std::memcmp(sample_.data(), other.sample_.data(), sample_.size() * sizeof(sample_[0])) == 0);
  }

 private:
  static constexpr std::size_t kStride = 32;  // a sample suffices: two sweeps of a sensor share hardly a point
  std::size_t size_ = 0;
  std::vector<Eigen::Vector3f> sample_;
};

}  // namespace rilo
