/// What sleepers lie on: bodies that do not answer, watched for a move.
#pragma once

#include <delassus/activity/inner/dormant.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/body_set.hpp>

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace delassus::inner {

/// The fixed and kinematic bodies with a shape as they were a step ago, and the gravity of each set.
template <class World, class Laws>
class Supports {
 public:
  /// near(box) where a support moved, will move within the step, came or went; an empty box means everywhere.
  template <class Near>
  void look(const World& world, double h, Near&& near) {
    now_.clear();
    world.each([&](const auto& set, auto s) {
      for (const Index b : set.active())
        if (!set.moves(b) && set.has_collider(b)) {
          const Pose pose = set.pose(b);
          now_.push_back({s, b, set.handle(b).generation, pose, Dormant<World, Laws>::box_of(set, b, pose)});
          const auto& v = set.velocity()[b];
          if (is_zero(v) && !runs(set, b)) continue;
          Aabb box = now_.back().box;
          const Vec3 way = h * converted<double>(linear_part(v));
          near(box.is_empty() ? box : box.extend(Aabb(box.min() + way, box.max() + way)));
        }
    });
    compare(near);
    supports_.swap(now_);
  }

  /// changed(number of the set) for every set whose gravity is another than a step ago.
  template <class Changed>
  void look_at_gravity(const World& world, Changed&& changed) {
    world.each([&](const auto& set, auto s) {
      const Vec3 now = gravity_of(set);
      if (now != gravity_[s]) changed(Index(s));
      gravity_[s] = now;
    });
  }
  void memory(auto& archive) { archive(gravity_, supports_); }

  /// Whether its surface moves though it does not.
  template <class Set>
  static bool runs([[maybe_unused]] const Set& set, [[maybe_unused]] Index b) {
    if constexpr (requires { set.surface_velocities(); }) return set.surface_velocities().runs(b);
    else return false;
  }

 private:
  struct Support {
    Index set, block;
    std::uint32_t generation;
    Pose pose;
    Aabb box;  ///< empty for a half-space
  };

  static bool before(const Support& x, const Support& y) {
    return std::tie(x.set, x.block, x.generation) < std::tie(y.set, y.block, y.generation);
  }
  /// Both lists ascend by set and block.
  template <class Near>
  void compare(Near&& near) const {
    auto then = supports_.begin();
    for (const Support& s : now_) {
      for (; then != supports_.end() && before(*then, s); ++then) near(then->box);
      const bool is_same = then != supports_.end() && !before(s, *then);
      if (is_same && s.pose.position == then->pose.position && s.pose.rotation == then->pose.rotation) {
        ++then;
        continue;
      }
      near(s.box);
      if (is_same) near((then++)->box);
    }
    for (; then != supports_.end(); ++then) near(then->box);
  }

  static std::array<Vec3, World::set_count> none() {
    std::array<Vec3, World::set_count> all;
    all.fill(Vec3::Zero());
    return all;
  }

  std::array<Vec3, World::set_count> gravity_ = none();
  std::vector<Support> supports_, now_;
};

}  // namespace delassus::inner
