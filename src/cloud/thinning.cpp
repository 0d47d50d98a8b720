#include "cloud/thinning.hpp"

#include <cmath>
#include <cstdint>
#include <span>

namespace rilo {

namespace {

/// Whether point i is one of the share. The multiples of the golden ratio are spread evenly over 0 … 1, and so are
/// those of every n-th point: no beam loses more points than another, as it would with a stride.
class Share {
 public:
  explicit Share(double share) : limit_(static_cast<std::uint64_t>(std::ldexp(share, 32))) {}
  bool has(std::size_t i) const { return static_cast<std::uint32_t>(i) * kGolden < limit_; }

 private:
  static constexpr std::uint32_t kGolden = 2654435769U;  // 2³² / golden ratio
  std::uint64_t limit_;
};

template <typename Column, typename Kept>
void thin(const Column& column, std::size_t size, const Share& share, Kept& kept) {
  kept.clear();
  if (column.size() != size) {
    return;
  }
  for (std::size_t i = 0; i < size; ++i) {
    if (share.has(i)) {
      kept.push_back(column[i]);
    }
  }
}

}  // namespace

SweepView thinned(const SweepView& sweep, double share, Sweep& kept) {
  const Share chosen(share);
  const std::size_t size = sweep.points.size();
  kept.stamp_ns = sweep.stamp_ns;
  thin(sweep.points, size, chosen, kept.points);
  thin(sweep.times_s, size, chosen, kept.times_s);
  thin(sweep.intensities, size, chosen, kept.intensities);
  thin(sweep.rings, size, chosen, kept.rings);
  return kept;
}

TimedCloud thinned(const TimedCloud& cloud, double share) {
  const Share chosen(share);
  TimedCloud kept;
  thin(cloud.points, cloud.size(), chosen, kept.points);
  thin(cloud.offsets_s, cloud.size(), chosen, kept.offsets_s);
  thin(cloud.counts, cloud.size(), chosen, kept.counts);
  thin(cloud.intensities, cloud.size(), chosen, kept.intensities);
  return kept;
}

std::vector<Eigen::Vector3f> evenly_picked(const std::vector<Eigen::Vector3f>& points, std::size_t count) {
  if (points.size() <= count) {
    return points;
  }
  std::vector<Eigen::Vector3f> picked;
  picked.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    picked.push_back(points[i * points.size() / count]);
  }
  return picked;
}

}  // namespace rilo
