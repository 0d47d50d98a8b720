// Whether a sensor takes its sweeps when their stamps say.
#pragma once

#include "registration/adaptive_icp.hpp"

namespace rilo {

/// Steps between stamps deviate from an even clock, because the sensor is uneven or because the stamps are not those of
/// the sweeps (of arrival, rounded). Motion tells which: a sweep that was taken late by τ has moved on by velocity · τ,
/// one that is only stamped late has not. Least squares of what the sweeps moved on by over that; stamps are believed
/// until motion contradicts.
class StampTrust {
 public:
  /// Share of a deviation that is motion, 0 … 1.
  double share() const;

  /// Standard deviation (s) of a step that deviates by `deviation_s` when share() of that is believed.
  double error_s(double deviation_s) const;

  /// Takes a sweep whose step deviated by `deviation_s`, share() of which was believed. `prior`: of its motion, without
  /// the error of its time; `icp`: its registration.
  void learn(double deviation_s, const MotionPrior& prior, const IcpResult& icp);

 private:
  double share_ = 1.0;
  double information_ = 1.0;     // of the share; at first it is known to ±1
  double mean_square_s2_ = 0.0;  // of the deviations
  int steps_ = 0;
};

}  // namespace rilo
