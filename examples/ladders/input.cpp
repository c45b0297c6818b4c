// HC-14: numbers that cannot be, where they are given and in the middle of a run.
#include "rows.hpp"
#include "watch.hpp"

namespace ladders {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = unbounded;

/// How many of the bodies that cannot be are taken, and how many are refused without a name in the sentence.
Marks offer(const std::vector<RigidBody>& wrong) {
  int taken = 0, nameless = 0;
  for (const RigidBody& body : wrong) {
    RigidBodies set;
    try {
      set.add(body);
      ++taken;
    } catch (const InvalidArgument& error) {
      nameless += std::string(error.what()).find("rigid body") == std::string::npos;
    }
  }
  return {{"taken", double(taken), 0, 0, 0}, {"refused without a name", double(nameless), unbounded, 0}};
}

RigidBody sound() { return {.mass = 1.0, .shape = Box{1, 1, 1}}; }

template <class Change, class... Values>
std::vector<RigidBody> each(Change change, Values... values) {
  std::vector<RigidBody> out;
  const auto add = [&](double value) {
    RigidBody body = sound();
    change(body, value);
    out.push_back(body);
  };
  (add(values), ...);
  return out;
}

}  // namespace

void bad_input(Ladder& ladder) {
  ladder.rung("positions",
              [] { return offer(each([](RigidBody& b, double x) { b.position.y() = x; }, nan, inf, -inf)); });
  ladder.rung("velocities", [] {
    return offer(each([](RigidBody& b, double x) { b.angular_velocity.y() = x; }, nan, inf, -inf));
  });
  ladder.rung("masses", [] {
    return offer(each([](RigidBody& b, double x) { b.mass = x; }, nan, inf, 0, -1, 5e-324));
  });
  ladder.rung("inertias", [] {
    return offer(each([](RigidBody& b, double x) { b.inertia = Mat3(Vec3(1, 1, x).asDiagonal()); }, nan, inf,
                      0, -1, 2.1, 5e-324));
  });
  ladder.rung("orientations", [] {
    return offer(each([](RigidBody& b, double x) { b.orientation = Quat(x, x, x, x); }, nan, inf, 0));
  });
  ladder.rung("shapes", [] {
    return offer(each([](RigidBody& b, double x) { b.shape = Box{1, x, 1}; }, nan, inf, 0, -1));
  });
  ladder.rung("steps, friction, restitution, limits", []() -> Marks {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}, Limit<Turn>{}}};
    auto& set = bodies<RigidBodies>(loop.world());
    const auto body = set.add(sound());
    int taken = 0;
    const auto refuses = [&](auto&& f) {
      try {
        f();
        ++taken;
      } catch (const InvalidArgument&) {
      }
    };
    for (const double h : {0., -1., nan, inf}) refuses([&] { loop.step(h); });
    for (const double mu : {-1., nan, inf})
      refuses([&] { AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{mu}}}}; });
    for (const double e : {-0.1, 1.1, nan})
      refuses([&] { AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{}, e}}}}; });
    refuses([&] {
      loop.add(
          Limit<Turn>::Item{.a = world_anchor({0, 0, 0}), .b = anchor(set, body), .lower = 1, .upper = 0});
    });
    return {{"taken", double(taken), 0, 0, 0}};
  });
  // A force that is not a number hits one of two boxes; the other is compared with its twin in a world
  // without that.
  ladder.rung("NaN force in the middle of a run", [&]() -> Marks {
    const auto fall = [&](bool is_hit) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      const auto kept = set.add(
          {.position = {0, 0, 0.6}, .angular_velocity = {1, 2, 3}, .mass = 1.0, .shape = Box{1, 1, 1}});
      const auto hit = set.add({.position = {5, 0, 0.6}, .mass = 1.0, .shape = Box{1, 1, 1}});
      bool is_told = !is_hit;
      run(ladder, loop, 3, frame, [&](int n) {
        is_told = is_told || loop.report().status == Status::quarantined;
        if (is_hit && n == 30) set.apply_force(hit, {nan, 0, 0});
      });
      return std::pair{set.position(kept), is_told && is_finite(set.position(hit))};
    };
    const auto [with, is_told] = fall(true);
    const Vec3 without = fall(false).first;
    return {{"told, and finite (0: yes)", is_told ? 0. : 1., 0, 0, 0},
            {"change of another island (m)", (with - without).norm(), 1e-9, 0}};
  });
}

}  // namespace ladders
