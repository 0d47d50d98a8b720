// Anderson acceleration of depth one.
#pragma once

#include <algorithm>

#include "registration/normal_equations.hpp"

namespace rilo {

/// The weights make each update a share of what is left only: it shrinks by about a half from one to the next. Anderson
/// acceleration of depth one (Walker and Ni 2011) takes the secant through the last two.
class Acceleration {
 public:
  void restart() { known_ = false; }

  /// What to move by, from the update of the equations and their information, in which updates are compared.
  Vector12d moved(const Vector12d& update, const Matrix12d& information) {
    Vector12d move = update;
    if (known_) {
      const Vector12d change = update - update_;
      const Vector12d weighted = information * change;
      const double length2 = change.dot(weighted);
      const double gamma = length2 > 0.0 ? update.dot(weighted) / length2 : 0.0;
      if (gamma < 0.0) {
        move -= std::max(gamma, -kMost) * (move_ + change);
      }
    }
    known_ = true;
    update_ = update;
    move_ = move;
    return move;
  }

 private:
  static constexpr double kMost = 4.0;  // steps; farther the secant is extrapolated too far
  bool known_ = false;
  Vector12d update_ = Vector12d::Zero();
  Vector12d move_ = Vector12d::Zero();
};

}  // namespace rilo
