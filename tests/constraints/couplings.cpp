// Gears, racks and screws: closed forms, no drift over a thousand turns, momentum of free bodies.
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include "constraints/poses.hpp"

namespace couplings_tests {

using namespace delassus;
using namespace poses;

namespace {

constexpr double pi = std::numbers::pi;

auto machine() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Slider{}, Gear{}, Rack{}, Screw{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-13}, MatrixFreeCompliance{}};
  bodies<RigidBodies>(loop.world()).gravity.setZero();
  return loop;
}

}  // namespace

TEMPLATE_TEST_CASE("H of a coupling is the derivative of its violation", "", Gear, Rack) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Scene scene(seed);
    const typename TestType::Item item{.a = scene.end(0, scene.turn()),
                                       .b = scene.end(1, scene.turn()),
                                       .c = scene.end(4, scene.turn()),
                                       .d = scene.end(0, scene.turn()),
                                       .ratio = -1.7,
                                       .phase = 0.1};
    const auto both = [&](const Anchor& x, const Anchor& y) {
      return 1 + (scene.world.frame(x) * unit_axis(2)).dot(scene.world.frame(y) * unit_axis(2));
    };
    const double least = std::min(both(item.a, item.c), both(item.b, item.d));
    if (least < 0.05) continue;  // as in coordinates.cpp
    const Written<TestType> rows({}, item, scene.world);
    CHECK(difference<1>(scene, rows.H, [&] { return Written<TestType>({}, item, scene.world).phi; }) <=
          1e-8 * (1 + std::pow(least, -3)));
  }
}

TEST_CASE("H of a screw is the derivative of its violation") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Scene scene(seed);
    const Screw::Item item{.a = scene.end(0, scene.turn()), .b = scene.end(1, scene.turn()), .pitch = 0.7};
    const double both =
        1 + (scene.world.frame(item.a) * unit_axis(2)).dot(scene.world.frame(item.b) * unit_axis(2));
    if (both < 0.05) continue;
    const Written<Screw> rows({}, item, scene.world);
    CHECK(difference<5>(scene, rows.H, [&] { return Written<Screw>({}, item, scene.world).phi; }) <=
          1e-8 * (1 + std::pow(both, -3)));
  }
}

// J_a α_a = τ + λ, J_b α_b = −ratio λ, α_a = ratio α_b: α_a = τ/(J_a + J_b/ratio²). J = 0.1, 0.4, ratio
// 3: 6.9230769.
TEST_CASE("a pair of gears takes a torque as its reduced inertia does, and meshes for a thousand turns") {
  auto loop = machine();
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto wheel = [&](double x, double J) {
    return rigid.add({.position = {x, 0, 0}, .mass = 1.0, .inertia = Mat3(Vec3(J, J, J).asDiagonal())});
  };
  const auto a = wheel(0, 0.1), b = wheel(2, 0.4);
  const Anchor c = world_anchor({0, 0, 0}), d = world_anchor({2, 0, 0});
  loop.add(Hinge::Item{c, anchor(rigid, a)});
  loop.add(Hinge::Item{d, anchor(rigid, b)});
  const auto gear =
      loop.add(Gear::Item{.a = anchor(rigid, a), .b = anchor(rigid, b), .c = c, .d = d, .ratio = -3});
  rigid.apply_torque(a, {0, 0, 1});
  const double h = 1e-2;
  loop.step(h);
  CHECK(rigid.angular_velocity(a).z() / h == Approx(1 / (0.1 + 0.4 / 9)).epsilon(1e-12));
  rigid.set_velocity(a, Vec3::Zero(), {0, 0, 20});
  rigid.set_velocity(b, Vec3::Zero(), {0, 0, -20.0 / 3});
  double worst = 0;
  const auto phi = [&] {
    const auto& item = loop.item(gear);
    return std::abs(item.position_a + 3 * item.position_b - item.phase);
  };
  for (int n = 0; n < 32000; ++n) {
    loop.step(h);
    worst = std::max(worst, phi());
  }
  CHECK(std::abs(loop.item(gear).position_a) > 1000 * 2 * pi);
  // A step turns a wheel by h ω but for (h ω)⁵/120; Baumgarte's 0.2 leaves five times that while the wheels
  // run. It does not grow, and goes when they stop: 0.8^100 = 2e-10 of it is left.
  CHECK(worst <= 5 * 0.2 * 0.2 * 0.2 * 0.2 * 0.2 / 120);
  for (const auto& w : {a, b}) rigid.set_velocity(w, Vec3::Zero());
  for (int n = 0; n < 101; ++n) loop.step(h);
  CHECK(phi() <= 1e-9);
}

// F = (m + J/r²) a.
TEST_CASE("a rack takes its wheel along") {
  auto loop = machine();
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double r = 0.15, m = 2, J = 0.03, h = 1e-2, F = 1.3;
  const Quat along = frame_along({1, 0, 0});
  const auto wheel = rigid.add({.position = {0, r, 0}, .mass = 1.0, .inertia = Mat3(J * Mat3::Identity())});
  const auto bar = rigid.add({.mass = m, .inertia = Mat3(Mat3::Identity())});
  const Anchor axle = world_anchor({0, r, 0}), rail = world_anchor(Vec3::Zero(), along);
  const Anchor on_wheel = anchor(rigid, wheel), on_bar = anchor(rigid, bar, Vec3::Zero(), along);
  loop.add(Hinge::Item{axle, on_wheel});
  loop.add(Slider::Item{rail, on_bar});
  loop.add(Rack::Item{.a = on_bar, .b = on_wheel, .c = rail, .d = axle, .ratio = r});
  rigid.apply_force(bar, {F, 0, 0});
  loop.step(h);
  CHECK(rigid.velocity(bar).x() == Approx(h * F / (m + J / (r * r))).epsilon(1e-12));
  CHECK(rigid.angular_velocity(wheel).z() == Approx(rigid.velocity(bar).x() / r).epsilon(1e-12));
}

// AC-16: (m − M) g/(m + M + I/r²) = 1.22625 m/s² for 2 and 1 kg over a wheel of 0.05 kg·m² and 0.1 m. What a
// step turns the wheel short of h ω, (h ω)⁵/120 of 0.012 rad at the end, is less than the solves leave.
TEST_CASE("Atwood's machine falls as the closed form says") {
  auto loop = machine();
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity = {0, 0, -9.81};
  const double r = 0.1, h = 1e-3, a = 1.22625;
  const Quat across = frame_along({0, 1, 0});
  const auto wheel = rigid.add({.mass = 1.0, .inertia = Mat3(0.05 * Mat3::Identity())});
  const Anchor axle = world_anchor(Vec3::Zero(), across),
               on_wheel = anchor(rigid, wheel, Vec3::Zero(), across);
  loop.add(Hinge::Item{axle, on_wheel});
  const auto hang = [&](double mass, double x) {
    const auto load = rigid.add({.position = {x, 0, -1}, .mass = mass, .inertia = Mat3(Mat3::Identity())});
    const Anchor rail = world_anchor({x, 0, -1}), on_load = anchor(rigid, load);
    loop.add(Slider::Item{rail, on_load});
    // About +y the side x > 0 goes down.
    loop.add(Rack::Item{.a = on_load, .b = on_wheel, .c = rail, .d = axle, .ratio = -x});
    return load;
  };
  const auto heavy = hang(2, r), light = hang(1, -r);
  loop.step(h);
  CHECK(rigid.velocity(heavy).z() == Approx(-h * a).epsilon(1e-12));
  CHECK(rigid.velocity(light).z() == Approx(h * a).epsilon(1e-12));
  for (int n = 1; n < 1000; ++n) loop.step(h);
  CHECK(rigid.velocity(heavy).z() == Approx(-a).epsilon(1e-9));
  CHECK(rigid.position(heavy).z() + 1 == Approx(-a / 2 * (1 + h)).epsilon(1e-7));
  CHECK(rigid.angular_velocity(wheel).y() == Approx(a / r).epsilon(1e-9));
}

// a = g/(1 + I (2π/p)²/m).
TEST_CASE("a nut falls along its screw as slowly as its inertia lets it") {
  auto loop = machine();
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity = {0, 0, -9.81};
  const double p = 0.1, m = 0.8, I = 4e-4, h = 1e-3;
  const auto nut = rigid.add({.mass = m, .inertia = Mat3(Vec3(3e-4, 3e-4, I).asDiagonal())});
  const auto screw =
      loop.add(Screw::Item{.a = world_anchor(Vec3::Zero()), .b = anchor(rigid, nut), .pitch = p});
  const double a = 9.81 / (1 + I * std::pow(2 * pi / p, 2) / m);
  loop.step(h);
  CHECK(rigid.velocity(nut).z() == Approx(-a * h).epsilon(1e-8));  // ω = 0.2
  for (int n = 1; n < 1000; ++n) loop.step(h);
  // v = n h a but for what the rotation's map is short of, (h ω)²/12 with ω = 2π/p · 3.2 = 200 at the end:
  // 0.3 %.
  CHECK(rigid.velocity(nut).z() == Approx(-a).epsilon(5e-3));
  CHECK(std::abs(loop.item(screw).position) > 10 * 2 * pi);
  CHECK(loop.item(screw).position * p / (2 * pi) == Approx(rigid.position(nut).z()).epsilon(5e-3));
}

// Sixty roundings of the impulses' size, which are those of the momenta.
TEST_CASE(
    "couplings and screws between free bodies keep momentum and angular momentum at any number of sweeps") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Gear{}, Rack{}, Screw{}},
                       GaussSeidel{.tolerance = 0, .max_iterations = 2}, MatrixFreeCompliance{}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.gravity.setZero();
    Scene draw(seed);
    std::vector<Anchor> ends;
    for (int i = 0; i < 3; ++i)
      ends.push_back(anchor(rigid,
                            rigid.add({.position = draw.vector(),
                                       .orientation = draw.turn(),
                                       .velocity = draw.vector(),
                                       .angular_velocity = draw.vector(),
                                       .mass = 1.5,
                                       .shape = Box{1, 2, 3}}),
                            draw.vector(), draw.turn()));
    loop.add(Gear::Item{.a = ends[0], .b = ends[1], .c = ends[2], .d = ends[2], .ratio = -2, .phase = 0.3});
    loop.add(Rack::Item{.a = ends[1], .b = ends[2], .c = ends[0], .d = ends[0], .ratio = 0.3, .phase = 0.1});
    loop.add(Screw::Item{.a = ends[0], .b = ends[2], .pitch = 0.5});
    Vec3 P = Vec3::Zero(), L = Vec3::Zero();
    double scale = 0;
    const auto add = [&](double sign) {
      for (const Anchor& e : ends) {
        const auto b = rigid.handle(e.block);
        const Mat3 R = rigid.orientation(b).toRotationMatrix();
        const Vec3 p = rigid.mass(b) * rigid.velocity(b), x = rigid.position(b),
                   l = x.cross(p) +
                       R * (rigid.inertia(e.block) * (R.transpose() * rigid.angular_velocity(b)));
        P += sign * p, L += sign * l;
        scale += p.norm() + l.norm();
      }
    };
    add(-1);
    loop.step(0.01);
    add(1);
    CAPTURE(seed, scale);
    CHECK(P.norm() <= 1e-13 * scale);
    CHECK(L.norm() <= 1e-13 * scale);
  }
}

TEST_CASE("a coupling goes when one of its carriers does, and refuses an end without an axis") {
  auto loop = machine();
  auto& rigid = bodies<RigidBodies>(loop.world());
  std::vector<RigidBodies::Handle> body;
  for (int i = 0; i < 3; ++i)
    body.push_back(rigid.add({.position = {double(i), 0, 0}, .mass = 1.0, .shape = Sphere{0.1}}));
  const auto gear = loop.add(Gear::Item{.a = anchor(rigid, body[0]),
                                        .b = anchor(rigid, body[1]),
                                        .c = anchor(rigid, body[2]),
                                        .d = world_anchor({1, 0, 0})});
  loop.remove(body[2]);
  CHECK_THROWS_WITH(
      loop.impulse(gear),
      "delassus: impulse: this constraint was removed, or is another loop's; its handle is stale");
  Anchor bare = anchor(rigid, body[0]);
  bare.has_frame = false;
  CHECK_THROWS_WITH(
      loop.add(Gear::Item{.a = bare,
                          .b = anchor(rigid, body[1]),
                          .c = world_anchor({0, 0, 0}),
                          .d = world_anchor({1, 0, 0})}),
      "delassus: Coupling, first joint: its second end needs an orientation; a particle has none");
}

}  // namespace couplings_tests
