#include "cloud/beam_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "cloud/fixed_chunks.hpp"
#include "cloud/point_block.hpp"

namespace rilo {

namespace {

constexpr float kMiddle = 0.5F * static_cast<float>(kBeams);  // index of the horizon
constexpr float kTangentStep = 0.0026F;        // 0.15° at the horizon: no sensor's beams lie much closer
constexpr std::size_t kFewestRevolutions = 4;  // fewer are no evidence of an order beam by beam
constexpr double kLargestShare = 0.25;         // of the variance of the tangents, within revolutions that are beams
// Motion compensation blurs the azimuth at which the revolutions begin: the seam is put 4° before the first point.
constexpr float kSeamCosine = 0.9976F;
constexpr float kSeamSine = 0.0698F;
constexpr int kQuadrants = 4;

Beam beam_of(float tangent) {
  const float bin = std::floor(tangent / kTangentStep) + kMiddle;
  return bin >= 0.0F && bin < static_cast<float>(kBeams) ? static_cast<Beam>(bin) : kNoBeam;
}

bool all_are(const PointBlock::Lanes<int>& lanes, int value) {
  int differences = 0;
  for (const int lane : lanes) {
    differences |= lane ^ value;
  }
  return differences == 0;
}

}  // namespace

/// Returns the sense in which the azimuth runs on from point to point, 1 or -1.
float BeamIndex::find_tangents(std::span<const Eigen::Vector3f> points) {
  tangents_.resize(points.size());
  forward_.assign(chunk_count(points.size()), 0);
  for_fixed_chunks(points.size(), [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    PointBlock p;
    alignas(64) PointBlock::Lanes<float> tangents;
    for_each_block(begin, end, [&](std::size_t first, std::size_t n) {
      p.load(&points[first], n);
      rilo::find_tangents(p, tangents);
      std::copy_n(tangents.begin(), n, tangents_.begin() + static_cast<std::ptrdiff_t>(first));
      forward_[chunk] += steps_in_azimuth(p);  // zeros beyond the points: no step
    });
  });
  const std::ptrdiff_t forward = std::accumulate(forward_.begin(), forward_.end(), std::ptrdiff_t{0});
  return forward >= 0 ? 1.0F : -1.0F;
}

bool BeamIndex::find_revolutions(std::span<const Eigen::Vector3f> points, float direction) {
  revolutions_.clear();
  const auto start = std::find_if(tangents_.begin(), tangents_.end(), [](float t) { return std::isfinite(t); });
  if (start == tangents_.end()) {
    return false;
  }
  find_borders(points, static_cast<std::size_t>(start - tangents_.begin()), direction);
  if (revolutions_.size() < kFewestRevolutions) {
    return false;
  }
  for_each_index(revolutions_.size(), [&](std::size_t t) {
    Revolution& revolution = revolutions_[t];
    for (std::size_t i = revolution.first; i < end_of(t); ++i) {
      if (const auto tangent = static_cast<double>(tangents_[i]); std::isfinite(tangent)) {
        ++revolution.count;
        revolution.sum += tangent;
        revolution.squares += tangent * tangent;
      }
    }
  });
  return revolutions_are_beams();
}

void BeamIndex::find_borders(std::span<const Eigen::Vector3f> points, std::size_t begin, float direction) {
  const Eigen::Vector2f p0(points[begin].x(), direction * points[begin].y());
  const Eigen::Vector2f seam(kSeamCosine * p0.x() + kSeamSine * p0.y(), kSeamCosine * p0.y() - kSeamSine * p0.x());
  // Quadrants gone through since the first point, counted with their sign: a few points that come back over a border
  // do not matter.
  int at = 0;
  int travelled = 0;
  PointBlock p;
  alignas(64) PointBlock::Lanes<int> quadrants;
  revolutions_.push_back({begin});
  for_each_block(begin, points.size(), [&](std::size_t first, std::size_t n) {
    p.load(&points[first], n);
    find_quadrants(p, seam, direction, quadrants);
    if (n == PointBlock::kSize && all_are(quadrants, at)) {
      return;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const int now = quadrants[i];
      if (now == at || !std::isfinite(tangents_[first + i])) {
        continue;
      }
      const int step = (now - at + kQuadrants) % kQuadrants;
      at = now;
      travelled += step == kQuadrants - 1 ? -1 : step;
      if (travelled >= kQuadrants * static_cast<int>(revolutions_.size())) {
        revolutions_.push_back({first + i});
      }
    }
  });
}

bool BeamIndex::revolutions_are_beams() const {
  double within = 0.0;
  Revolution all;
  for (const Revolution& revolution : revolutions_) {
    within += revolution.squares - revolution.sum * revolution.sum / static_cast<double>(revolution.count);
    all.count += revolution.count;
    all.sum += revolution.sum;
    all.squares += revolution.squares;
  }
  return within < kLargestShare * (all.squares - all.sum * all.sum / static_cast<double>(all.count));
}

void BeamIndex::assign(const SweepView& sweep, std::vector<Beam>& beams) {
  const std::size_t n = sweep.points.size();
  beams.assign(n, kNoBeam);
  if (sweep.rings.size() == n) {
    std::transform(sweep.rings.begin(), sweep.rings.end(), beams.begin(),
                   [](std::uint16_t ring) { return ring < kBeams ? ring : kNoBeam; });
    return;
  }
  if (!find_revolutions(sweep.points, find_tangents(sweep.points))) {
    for_fixed_chunks(n, [&](std::size_t, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        beams[i] = std::isfinite(tangents_[i]) ? beam_of(tangents_[i]) : kNoBeam;
      }
    });
    return;
  }
  for (std::size_t t = 0; t < revolutions_.size(); ++t) {
    const Revolution& revolution = revolutions_[t];
    const Beam beam = beam_of(static_cast<float>(revolution.sum / static_cast<double>(revolution.count)));
    std::fill(beams.begin() + static_cast<std::ptrdiff_t>(revolution.first),
              beams.begin() + static_cast<std::ptrdiff_t>(end_of(t)), beam);
  }
}

}  // namespace rilo
