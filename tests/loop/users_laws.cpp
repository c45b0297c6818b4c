// Laws with two and with seven rows and a body set, none of which the library knows. They run with delassus/compiled.hpp here and
// without it in users_laws_alone.cpp.
#include <delassus/delassus.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "catch.hpp"

namespace users_laws_tests {

using namespace delassus;

namespace {

/// φ = (e_x, e_y) · (x_a − x_b): the end a stays on the line through b along the z axis of b's frame.
struct OnWire : Bilateral<2> {
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 x = world.point(item.a), from = x - world.point(item.b);
    const Mat3 axes = world.axes(item.b);
    auto a = row.end(item.a, x), b = row.end(item.b, x);
    for (int k = 0; k < 2; ++k) {
      const Vec3 e = axes.col(k);
      a.along(k, e), b.along(k, -e);
      row.phi(k, e.dot(from));
    }
  }
};

/// The x axis of one end stays square to the y axis of the other.
void keep_square(const auto& world, auto& row, const Anchor& of, const Anchor& to, int k) {
  const Vec3 x = world.axes(of).col(0), y = world.axes(to).col(1);
  row.end(of, world.point(of)).about(k, x.cross(y));
  row.end(to, world.point(to)).about(k, -x.cross(y));
  row.phi(k, x.dot(y));
}
struct Square : Bilateral<1> {
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item& item, const auto& world, auto row) const { keep_square(world, row, item.a, item.b, 0); }
};

/// Two ball joints, a with b and c with d, written as BallJoint does, and the frames of b and d square: seven rows.
struct Yoke : Bilateral<7> {
  struct Item {
    Anchor a, b, c, d;
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    join(item.a, item.b, world, row, 0);
    join(item.c, item.d, world, row, 3);
    keep_square(world, row, item.b, item.d, 6);
  }

 private:
  static void join(const Anchor& a, const Anchor& b, const auto& world, auto& row, int first) {
    const Vec3 xa = world.point(a), xb = world.point(b), middle = 0.5 * (xa + xb);
    auto on_a = row.end(a, middle), on_b = row.end(b, middle);
    for (int k = 0; k < 3; ++k) {
      on_a.along(first + k, unit_axis(k)), on_b.along(first + k, -unit_axis(k));
      row.phi(first + k, xa[k] - xb[k]);
    }
  }
};

/// Particles that a spring pulls to the origin, N/m.
struct Tethered : Particles {
  double stiffness = 0;
  void add_forces(std::span<Vec3> p) const {
    Particles::add_forces(p);
    for (Index b = 0; b < blocks(); ++b) p[std::size_t(b)] -= stiffness * point({.block = b});
  }
};

/// Three boxes in a row, turning; f(loop, bodies, ends) joins the first and the last to the middle one.
template <class... Laws, class Join>
std::array<Vec3, 3> after_a_second(Constraints<Laws...> laws, const Join& join, double& worst) {
  AnimationLoop loop{World{RigidBodies{}}, std::move(laws), AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 20000}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  std::array<RigidBodies::Handle, 3> box;
  for (int i = 0; i < 3; ++i)
    box[std::size_t(i)] = rigid.add({.position = {1.0 * i, 0, 0},
                                     .angular_velocity = {0.5 * i, 1 - 0.7 * i, 0.3},
                                     .mass = 1.0 + i,
                                     .shape = Box{0.8, 0.4, 0.2}});
  rigid.gravity = Vec3::Zero();
  const auto end = [&](int i, double x) { return anchor(rigid, box[std::size_t(i)], {x, 0, 0}); };
  join(loop, end(1, -0.5), end(0, 0.5), end(1, 0.5), end(2, -0.5));
  const Vec3 p = momentum(rigid), l = angular_momentum(rigid);
  for (int i = 0; i < 200; ++i) {
    REQUIRE(loop.step(5e-3).status == Status::converged);
    worst = std::max(worst, loop.report().max_joint_violation);
  }
  CHECK((momentum(rigid) - p).norm() <= 1e-12);
  CHECK((angular_momentum(rigid) - l).norm() <= 1e-11);
  return {rigid.position(box[0]), rigid.position(box[1]), rigid.position(box[2])};
}

}  // namespace

TEST_CASE("a law of seven rows moves bodies as the laws that it is made of do") {
  double worst = 0, worst_parts = 0;
  const auto whole = after_a_second(Constraints{Yoke{}}, [](auto& loop, const Anchor& a, const Anchor& b, const Anchor& c, const Anchor& d) {
    loop.add(Yoke::Item{a, b, c, d});
  }, worst);
  const auto parts = after_a_second(Constraints{BallJoint{}, Square{}}, [](auto& loop, const Anchor& a, const Anchor& b, const Anchor& c, const Anchor& d) {
    loop.add(BallJoint::Item{a, b});
    loop.add(BallJoint::Item{c, d});
    loop.add(Square::Item{b, d});
  }, worst_parts);
  // Both are solved to 1e-13 of their velocities, of order one, in each of 200 steps of 5 ms, and errors grow as the motion lets them.
  for (std::size_t i = 0; i < 3; ++i) CHECK((whole[i] - parts[i]).norm() <= 1e-9);
  CHECK((whole[0] - Vec3(0, 0, 0)).norm() > 0.05);
  CHECK(worst < 1e-2);
  CHECK(worst == Approx(worst_parts).margin(1e-9));
}

TEST_CASE("a law of two rows holds a body set of a user's on a wire, along which it swings") {
  Tethered set;
  set.stiffness = 4;
  AnimationLoop loop{World{set}, Constraints{OnWire{}}};
  auto& beads = bodies<Tethered>(loop.world());
  beads.gravity = Vec3::Zero();
  const Vec3 e = Vec3(1, 2, 2) / 3;
  const double h = 1e-2, m = 0.5, k = 4;
  const auto bead = beads.add({.position = 0.6 * e, .mass = m});
  loop.add(OnWire::Item{anchor(beads, bead), world_anchor(Vec3::Zero(), frame_along<double>(e))});
  // Symplectic Euler keeps ½ m v² + ½ k x² − ½ h k v x of a linear spring.
  const auto kept = [&] {
    const double x = e.dot(beads.position(bead)), v = e.dot(beads.velocity(bead));
    return 0.5 * m * v * v + 0.5 * k * x * x - 0.5 * h * k * v * x;
  };
  const double start = kept();
  double lowest = 1;
  for (int i = 0; i < 500; ++i) {
    loop.step(h);
    const Vec3 x = beads.position(bead);
    lowest = std::min(lowest, e.dot(x));
    REQUIRE((x - e.dot(x) * e).norm() <= 1e-12);
  }
  CHECK(lowest < -0.59);
  CHECK(std::abs(kept() - start) <= 500 * 16 * std::numeric_limits<double>::epsilon() * start);
}

}  // namespace users_laws_tests
