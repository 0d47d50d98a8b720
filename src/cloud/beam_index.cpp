#include "cloud/beam_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cloud/fixed_chunks.hpp"

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

int quadrant(float x, float y) {
  if (y >= 0.0F) {
    return x >= 0.0F ? 0 : 1;
  }
  return x < 0.0F ? 2 : 3;
}

}  // namespace

/// Returns the sense in which the azimuth runs on from point to point, 1 or -1.
float BeamIndex::find_tangents(std::span<const Eigen::Vector3f> points) {
  tangents_.resize(points.size());
  forward_.assign(chunk_count(points.size()), 0);
  for_fixed_chunks(points.size(), [&](std::size_t chunk, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Vector3f& p = points[i];
      const Eigen::Vector3f& before = points[i > 0 ? i - 1 : 0];
      tangents_[i] = p.z() / std::sqrt(p.x() * p.x() + p.y() * p.y());
      const float turned = before.x() * p.y() - before.y() * p.x();
      forward_[chunk] += (turned > 0.0F ? 1 : 0) - (turned < 0.0F ? 1 : 0);
    }
  });
  const std::ptrdiff_t forward = std::accumulate(forward_.begin(), forward_.end(), std::ptrdiff_t{0});
  return forward >= 0 ? 1.0F : -1.0F;
}

bool BeamIndex::find_revolutions(std::span<const Eigen::Vector3f> points, float direction) {
  // Quadrants gone through since the first point, counted with their sign: a few points that come back over a border
  // do not matter.
  revolutions_.clear();
  Eigen::Vector2f seam = Eigen::Vector2f::Zero();
  int at = 0;
  int travelled = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(tangents_[i])) {
      continue;
    }
    const Eigen::Vector2f p(points[i].x(), direction * points[i].y());
    if (revolutions_.empty()) {
      seam = {kSeamCosine * p.x() + kSeamSine * p.y(), kSeamCosine * p.y() - kSeamSine * p.x()};
      revolutions_.push_back({i});
    }
    const int now = quadrant(seam.dot(p), seam.x() * p.y() - seam.y() * p.x());
    const int step = (now - at + kQuadrants) % kQuadrants;
    at = now;
    travelled += step == kQuadrants - 1 ? -1 : step;
    if (travelled >= kQuadrants * static_cast<int>(revolutions_.size())) {
      revolutions_.push_back({i});
    }
    Revolution& revolution = revolutions_.back();
    const auto tangent = static_cast<double>(tangents_[i]);
    ++revolution.count;
    revolution.sum += tangent;
    revolution.squares += tangent * tangent;
  }
  return revolutions_.size() >= kFewestRevolutions && revolutions_are_beams();
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
    std::transform(tangents_.begin(), tangents_.end(), beams.begin(),
                   [](float tangent) { return std::isfinite(tangent) ? beam_of(tangent) : kNoBeam; });
    return;
  }
  for (std::size_t t = 0; t < revolutions_.size(); ++t) {
    const Revolution& revolution = revolutions_[t];
    const std::size_t end = t + 1 < revolutions_.size() ? revolutions_[t + 1].first : n;
    const Beam beam = beam_of(static_cast<float>(revolution.sum / static_cast<double>(revolution.count)));
    std::fill(beams.begin() + static_cast<std::ptrdiff_t>(revolution.first),
              beams.begin() + static_cast<std::ptrdiff_t>(end), beam);
  }
}

}  // namespace rilo
