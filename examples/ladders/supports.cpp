// HC-10: what stands on more supports than it needs.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/collision/with_compounds.hpp>
#include <delassus/solvers/minimum_norm.hpp>

#include <array>
#include <numbers>

namespace ladders {

namespace {

/// Where a load can go into the ground, and how much of it does in a step, N.
struct Support {
  double x, y;
  double load = 0, before = 0;
};

/// Of all contact forces that carry F = (F_z, F_z x, F_z y), all of z, the smallest by Σ w_i F_i²: (α + β x_i
/// + γ y_i)/w_i, w_i = tr(1/m + [r]ᵀ I⁻¹ [r])/3. The largest difference of what the loop found from them, N.
double off_the_smallest(const auto& loop, RigidBodies::Handle top, const Vec3& F) {
  const auto& set = bodies<RigidBodies>(loop.world());
  const Mat3 over = set.inertia(top.index).inverse();
  const auto row = [&](const ContactResult& c) {
    const Vec3 r = c.record.point() - set.position(top);
    const double w = 3 / set.mass(top.index) + over.trace() * r.squaredNorm() - r.dot(over * r);
    return Vec<4>(1, r.x(), r.y(), w);  // of a principal frame
  };
  Mat3 sum = Mat3::Zero();
  for (const ContactResult& c : loop.contacts()) {
    const Vec<4> at = row(c);
    sum += at.head<3>() * at.head<3>().transpose() / at[3];
  }
  const Vec3 share = sum.inverse() * F;
  double most = 0;
  for (const ContactResult& c : loop.contacts()) {
    const Vec<4> at = row(c);
    const Vec3 force = c.impulse / loop.step_size();
    most = ladders::most(
        most, std::hypot(force.x(), force.y(), std::abs(force.z()) - share.dot(at.head<3>()) / at[3]));
  }
  return most;
}

// 10 kg stand on supports while a load of 40 N goes round on them in 4 s: nothing moves, and no force jumps.
template <class Loop>
Marks loaded(Ladder& ladder, Loop& loop, RigidBodies::Handle top, std::vector<Support> supports) {
  using std::numbers::pi;
  auto& set = bodies<RigidBodies>(loop.world());
  const Vec3 start = set.position(top);
  const double weight = set.mass(top.index) * g, load = 40, share = weight / double(supports.size());
  double error = 0, growth = 0, moved = 0;
  const auto at = [&](int step) {
    return 0.3 * Vec3(std::cos(2 * pi * step * frame / 4), std::sin(2 * pi * step * frame / 4), 0);
  };
  const auto nearest = [&](const Vec3& x) -> Support& {
    const auto far = [&](const Support& s) { return std::hypot(x.x() - s.x, x.y() - s.y); };
    return *std::min_element(supports.begin(), supports.end(),
                             [&](const Support& a, const Support& b) { return far(a) < far(b); });
  };
  set.apply_force(top, {0, 0, -load}, start + at(0));
  run(ladder, loop, ladder.is_quick() ? 1 : 8, frame, [&](int step) {
    for (Support& s : supports) s.before = s.load, s.load = 0;
    for (const ContactResult& c : loop.contacts())
      nearest(c.record.point() - start).load += std::abs(c.impulse.z()) / frame;
    for (const Support& s : supports) {
      const double now = std::max(s.load, 0.01 * share), then = std::max(s.before, 0.01 * share);
      if (step > 0) growth = most(growth, std::max(now / then, then / now));
    }
    error = most(error,
                 off_the_smallest(loop, top, Vec3(weight + load, load * at(step).x(), load * at(step).y())));
    moved = most(moved, (set.position(top) - start).norm());
    set.apply_force(top, {0, 0, -load}, start + at(step + 1));
  });
  return {{"moved by (m)", moved, 1e-3, 1e-6},
          {"a support's load grows or shrinks in a step, times", growth, unbounded, 10},
          {"off the smallest forces / a support's share", error / share, unbounded, 1e-3}};
}

template <class... Policies>
void climb_supports(Ladder& ladder, const Policies&... policies) {
  const Constraints laws{Contact{Coulomb{.friction = 0.5}}};
  for (const auto& [rows, columns] : {std::array{2, 4}, {4, 4}, {6, 6}, {10, 10}})
    ladder.rung(format("box on %d balls", rows * columns), [&, rows = rows, columns = columns]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, laws, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      std::vector<Support> supports;
      for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
          supports.push_back({-0.45 + 0.9 * i / (rows - 1), -0.45 + 0.9 * k / (columns - 1)});
          set.add_fixed(Sphere{0.02}, {supports.back().x, supports.back().y, -0.02});
        }
      return loaded(ladder, loop, set.add({.position = {0, 0, 0.1}, .mass = 10.0, .shape = Box{1, 1, 0.2}}),
                    supports);
    });
  ladder.rung("table on 4 legs", [&]() -> Marks {
    AnimationLoop loop{World{RigidBodies{}}, laws, WithCompounds{NativeCollision{}}, policies...};
    auto& set = bodies<RigidBodies>(loop.world());
    set.add_fixed(HalfSpace{});
    std::vector<CompoundPart> parts{{.shape = Box{1, 1, 0.1}, .position = {0, 0, 0.45}}};
    std::vector<Support> supports;
    for (const double x : {-0.4, 0.4})
      for (const double y : {-0.4, 0.4}) {
        parts.push_back({.shape = Box{0.1, 0.1, 0.4}, .position = {x, y, 0.2}});
        supports.push_back({x, y});
      }
    const Compound table(parts);
    const auto top = set.add({.position = table.centre(),
                              .mass = 10.0,
                              .inertia = Mat3(10 / table.mass() * table.inertia()),
                              .shape = loop.template get<WithCompounds<NativeCollision>>().add(table)});
    return loaded(ladder, loop, top, supports);
  });
}

}  // namespace

void supports(Ladder& ladder) { climb_supports(ladder); }
void supports_shared(Ladder& ladder) {
  climb_supports(ladder, MinimumNorm{AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 5000}});
}

}  // namespace ladders
