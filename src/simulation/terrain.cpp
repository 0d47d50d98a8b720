#include "simulation/terrain.hpp"

#include <cmath>
#include <numbers>

#include "simulation/counter_random.hpp"

namespace rilo::simulation {

Terrain::Terrain(std::uint64_t seed) {
  // Hills, and shorter waves down to the length of a car.
  constexpr std::array<double, 5> kLengthsM = {130, 70, 31, 14, 6.5};
  constexpr std::array<double, 5> kAmplitudesM = {0.55, 0.3, 0.1, 0.025, 0.006};
  RandomStream random(seed, 0x7e55a1);
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    const double heading = random.uniform(0, 2 * std::numbers::pi);
    waves_[i].wave_number =
        (2 * std::numbers::pi / kLengthsM[i]) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    waves_[i].phase = random.uniform(0, 2 * std::numbers::pi);
    waves_[i].amplitude_m = kAmplitudesM[i];
  }
}

double Terrain::height(const Eigen::Vector2d& p) const {
  double sum = 0;
  for (const Wave& w : waves_) sum += w.amplitude_m * std::sin(w.wave_number.dot(p) + w.phase);
  return sum;
}

}  // namespace rilo::simulation
