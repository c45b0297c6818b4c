/// Surfaces that run beside their bodies, as belts do.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

namespace delassus::inner {

/// One motion a body, in its own axes and about its centre of mass. Empty while no surface runs.
class SurfaceVelocities {
 public:
  bool are_any() const { return running_ > 0; }
  bool may_turn() const { return are_any() && turns_; }  ///< one of them had an angular one
  bool runs(Index b) const { return b < Index(by_body_.size()) && by_body_[b].runs; }

  /// m/s and rad/s.
  void set(Index b, const Vec3& linear, const Vec3& angular) {
    drop(b);
    if (is_zero(linear) && is_zero(angular)) return;
    while (Index(by_body_.size()) <= b) by_body_.push_back({});
    by_body_[b] = {linear, angular, true};
    ++running_;
    turns_ = turns_ || !is_zero(angular);
  }
  void drop(Index b) {
    if (!runs(b)) return;
    by_body_[b] = {};
    --running_;
  }

  /// At the point `arm` of the body (m), m/s.
  Vec3 at(Index b, const Vec3& arm) const {
    if (!runs(b)) return zero<Vec3>();
    return by_body_[b].linear + cross(by_body_[b].angular, arm);
  }

  /// rad/s.
  Vec3 turn(Index b) const { return runs(b) ? by_body_[b].angular : Vec3(zero<Vec3>()); }

  void memory(auto& archive) { archive(by_body_, running_, turns_); }

 private:
  struct Motion {
    Vec3 linear = zero<Vec3>(), angular = zero<Vec3>();
    bool runs = false;
  };
  Array<Motion> by_body_;
  Index running_ = 0;  ///< how many
  bool turns_ = false;
};

}  // namespace delassus::inner
