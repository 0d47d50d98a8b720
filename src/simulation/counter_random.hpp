// Random numbers that depend on a place (seed, sweep, beam, column, …) and not on the order of asking: the same drive
// for any number of threads. The standard library's distributions differ between implementations; these do not.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace rilo::simulation {

/// splitmix64's finaliser: every input bit reaches every output bit.
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

template <typename... Keys>
std::uint64_t hash(std::uint64_t seed, Keys... keys) {
  std::uint64_t h = mix(seed);
  ((h = mix(h ^ static_cast<std::uint64_t>(keys))), ...);
  return h;
}

/// Uniform in [0, 1).
inline double unit(std::uint64_t h) { return static_cast<double>(h >> 11U) * 0x1.0p-53; }

/// Standard normal (Box and Muller), from one hash.
inline double gaussian(std::uint64_t h) {
  const double u = 1.0 - unit(h);  // (0, 1]: the logarithm is finite
  const double v = unit(mix(h));
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

/// The numbers of one thing to be laid out (a building, a car, …), drawn one after the other.
class RandomStream {
 public:
  template <typename... Keys>
  explicit RandomStream(std::uint64_t seed, Keys... keys) : key_(hash(seed, keys...)) {}

  double uniform(double low, double high) { return low + (high - low) * unit(mix(key_ + count_++)); }
  bool chance(double share) { return uniform(0, 1) < share; }
  double normal() { return gaussian(mix(key_ + count_++)); }

 private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace rilo::simulation
