/// Where kinematic bodies shall be at the end of the step.
#pragma once

#include <delassus/bodies/inner/rigid_state.hpp>
#include <delassus/core/array.hpp>
#include <delassus/math/rotation.hpp>

#include <cstddef>

namespace delassus::inner {

class Targets {
 public:
  void resize(std::size_t n) { targets_.resize(n); }
  void set(Index b, const Vec3& position, const Quat& orientation) {
    assign(targets_[b].position, position);
    targets_[b].orientation = unit(orientation);
    targets_[b].is_set = true;
    are_any_ = true;
  }
  void drop(Index b) { targets_[b].is_set = false; }

  /// f(b, velocity) for the bodies of `active` that have one: (q(t+h) ⊖ q(t)) / h from the present state.
  template <class T, class F>
  void each_velocity(const Array<Index>& active, const RigidState<T>& state, double h, F&& f) {
    if (!are_any_) return;
    are_any_ = false;
    for (const Index b : active) {
      if (!targets_[b].is_set) continue;
      are_any_ = true;
      const Quat now = converted<double>(state.q[b]);
      const Vec3 way = targets_[b].position - state.x[b],
                 turn = logarithm<double>(product(targets_[b].orientation, conjugate(now)));
      f(b, twist<T>(converted<T>(way / h), converted<T>(turn / h)));
    }
  }

  /// Puts the body where it was told, exactly, and forgets that it was; false when it was not told.
  template <class T>
  bool reach(Index b, RigidState<T>& state) {
    if (is_on_the_way_ || !targets_[b].is_set) return false;
    state.place(b, targets_[b].position, targets_[b].orientation);
    drop(b);
    return true;
  }

  /// While a step is done in parts, its end is not reached before the last of them.
  void stay_on_the_way(bool is_on_the_way) { is_on_the_way_ = is_on_the_way; }

  void memory(auto& archive) { archive(targets_, are_any_); }

 private:
  struct Target {
    Vec3 position = zero<Vec3>();
    Quat orientation = Quat::Identity();
    bool is_set = false;
  };
  Array<Target> targets_;
  bool are_any_ = false;  ///< one is set and the step that goes there is not over
  bool is_on_the_way_ = false;
};

}  // namespace delassus::inner
