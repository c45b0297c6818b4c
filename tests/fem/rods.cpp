#include <delassus/bodies/world.hpp>
#include <delassus/fem/rods.hpp>

#include <limits>

#include "catch.hpp"
#include "rod_scenes.hpp"

using namespace delassus;
using namespace rod_scenes;

TEST_CASE("a rod turned and moved as a whole has no elastic force and no energy") {
  for (const double angle : {0.3, 179 * M_PI / 180}) {
    Rods set;
    const auto rod = set.add(bent_rod());
    const Quat turn = exponential<double>(angle * Vec3(1, 2, -2) / 3);
    for (Index k = 0; k < set.node_count(rod); ++k) {
      const auto node = set.node(rod, k);
      set.place(node, Vec3(3, -1, 2) + turn * set.position(node), turn * set.orientation(node));
    }
    // E A = 200 N, places of 3 m rounded to 4e-16 over segments of 0.16 m: 1e-12 N.
    for (const auto& f : elastic_forces(set)) CHECK(f.norm() < 1e-11);
    CHECK(std::abs(set.elastic_energy()) < 1e-24);
  }
}

TEST_CASE("forces and moments of a rod are the derivative of its energy") {
  Rods set;
  set.add(bent_rod());
  shake(set, 0.02, 0.5);
  const auto f = elastic_forces(set);
  const double step = 1e-6;
  double size = 0, worst = 0;
  for (const Index b : set.active())
    for (int k = 0; k < 6; ++k) {
      Vec<6> e = Vec<6>::Zero();
      const auto energy_at = [&](double s) {
        set.shift(0);
        e[k] = s;
        set.displace(b, e);
        const double energy = set.elastic_energy();
        set.restore();
        return energy;
      };
      const double difference = (energy_at(step) - energy_at(-step)) / (2 * step);
      worst = std::max(worst, std::abs(f[b][k] + difference));
      size = std::max(size, std::abs(f[b][k]));
    }
  CHECK(size > 1);
  CHECK(worst < 1e-7 * size);  // step² of the third derivative and ε Ψ/step: 1e-9 of it each, times some tens
}

TEST_CASE("elastic forces of a rod sum to nothing, and their moments too") {
  Rods set;
  set.add(bent_rod());
  shake(set, 0.05, 1);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0;
  const auto f = elastic_forces(set);
  for (const Index b : set.active()) {
    sum += linear_part(f[b]);
    moment += set.position(set.handle(b)).cross(linear_part(f[b])) + angular_part(f[b]);
    size += f[b].norm();
  }
  CHECK(size > 1);
  CHECK(sum.norm() < 1e-14 * size);
  CHECK(moment.norm() < 1e-14 * size);
}

TEST_CASE("A = M + h^2 K of a rod at rest is the derivative of its forces") {
  Rods set;
  set.gravity.setZero();
  const auto rod = set.add(bent_rod());
  set.fix(set.node(rod, 0));
  std::vector<Vec<6>> direction(set.blocks(), Vec<6>::Zero());
  for (const Index b : set.active())
    for (int k = 0; k < 6; ++k)
      if (set.moves(b)) direction[b][k] = std::cos(3 * b + 2 * k);
  const double h2 = 1e-2, step = 1e-6;
  const auto forces_at = [&](double s) {
    set.shift(0);
    for (const Index b : set.active()) set.displace(b, Vec<6>(s * direction[b]));
    const auto f = elastic_forces(set);
    set.restore();
    return f;
  };
  const auto up = forces_at(step), down = forces_at(-step);
  std::vector<Vec<6>> y(set.blocks());
  for (const Index b : set.active())
    y[b] = set.momentum(b, direction[b]) - h2 / (2 * step) * (up[b] - down[b]);
  set.factor({.mass = 1, .stiffness = h2});
  set.solve(y);
  double worst = 0;
  for (const Index b : set.active()) worst = std::max(worst, (y[b] - direction[b]).norm());
  CHECK(worst > 0);
  // Of the differences 1e-12 of k = E A/L is left, against the least of A: c h² ≈ 3e-3, and κ(A) ≈ 1e5 more.
  CHECK(worst < 1e-4);
}

TEST_CASE("the stiffness of a shaken rod is positive, and resists no turn of a rod that nothing pulls") {
  Rods set;
  set.gravity.setZero();
  set.add(bent_rod());
  shake(set, 0.05, 1);
  // v·K v for random v, by the force −K v.
  std::mt19937 random(5);
  for (int n = 0; n < 20; ++n) {
    set.factor({.mass = 1, .stiffness = 1});
    for (auto& v : set.velocity()) {
      const Vec3 a = draw_vector(random, 1), b = draw_vector(random, 1);
      v = twist<double>(a, b);
    }
    std::vector<Vec<6>> p(set.blocks(), Vec<6>::Zero());
    set.add_stiffness_times_velocity(p, 1);
    double product = 0;
    for (const Index b : set.active()) product -= p[b].dot(set.velocity()[b]);
    CHECK(product > 0);
  }
  // The forces K v of a rod that is bent and pressed vanish where v is a turn about a point.
  Rods bent;
  bent.gravity.setZero();
  const auto rod =
      bent.add({.points = straight_line({0, 0, 0}, {1, 0, 0}, 4), .section = round_section(0.01)});
  for (Index k = 0; k <= 4; ++k)
    bent.place(bent.node(rod, k), {0.24 * double(k), 0, 0},
               exponential<double>(double(k * k) * Vec3(0.01, 0.04, 0.02)));
  bent.factor({.mass = 1, .stiffness = 1});
  const Vec3 turn(0.3, -0.5, 0.7), about(0.2, 0.1, 0);
  for (const Index b : bent.active())
    bent.velocity()[b] = twist<double>(turn.cross(Vec3(bent.position(bent.handle(b)) - about)), turn);
  std::vector<Vec<6>> p(bent.blocks(), Vec<6>::Zero());
  bent.add_stiffness_times_velocity(p, 1);
  for (const auto& x : p) CHECK(x.norm() < 1e-9);  // E A/L = 1e6 N/m times ε
}

TEST_CASE("a rod that cannot be one is refused, and says why") {
  Rods set;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](auto&& change, const char* why) {
    Rod rod = bent_rod();
    change(rod);
    CHECK_THROWS_WITH(set.add(rod), Catch::Contains(why));
    CHECK(set.blocks() == 0);
  };
  refused([](Rod& r) { r.points.resize(1); }, "rod #0: it has 1 points; a rod needs two at least");
  refused([&](Rod& r) { r.points[2][1] = nan; }, "rod #0: point #2 is not finite");
  refused([](Rod& r) { r.points[3] = r.points[2]; }, "rod #0: segment #2 is 0 m long");
  refused([](Rod& r) { r.points[3] = r.points[1]; }, "rod #0: the line turns back on itself at point #2");
  refused([](Rod& r) { r.section = round_section(0); }, "of its section must be finite and > 0");
  refused([](Rod& r) { r.young = -1; }, "rod #0: Young's modulus -1 Pa must be finite and > 0");
  refused([](Rod& r) { r.poisson = 0.6; }, "rod #0: Poisson's ratio 0.6 must lie in (-1, 0.5]");
  refused([](Rod& r) { r.density = 0; }, "rod #0: density 0 kg/m³ must be finite and > 0");
  refused([&](Rod& r) { r.velocity[0] = nan; }, "rod #0: position or velocity is not finite");
  refused([](Rod& r) { r.orientation = Quat(2, 0, 0, 0); }, "rod #0: orientation is not a unit quaternion");
  refused([](Rod& r) { r.contact_radius = -1; }, "rod #0: contact_radius -1 m must be finite and >= 0");
  refused([](Rod& r) { r.contact_radius = 0.01, r.collides_with = ~0u; }, "would collide with each other");
  refused([](Rod& r) { r.density = 1e-320; }, "node 0 has a mass of");
  // Even powers would hide the sign.
  CHECK_THROWS_WITH(round_section(-0.01),
                    Catch::Contains("round_section: radius -0.01 m must be finite and >= 0"));
  CHECK_THROWS_WITH(rectangular_section(-0.01, -0.02), Catch::Contains("side along y -0.01 m"));
  CHECK_THROWS_WITH(rectangular_section(0.01, nan), Catch::Contains("side along z nan m"));
  CHECK_THROWS_WITH(tube_section(-0.02, 0.01), Catch::Contains("tube_section: outer radius -0.02 m"));
  CHECK_THROWS_WITH(tube_section(0.02, -0.01), Catch::Contains("tube_section: inner radius -0.01 m"));
  CHECK_THROWS_WITH(straight_line({0, 0, 0}, {1, 0, 0}, 0), Catch::Contains("0 segments"));
  const auto rod = set.add(bent_rod());
  CHECK_THROWS_WITH(set.node(rod, 7), Catch::Contains("rod #0 has nodes 0 to 6, not 7"));
  set.fix(set.node(rod, 0));
  CHECK_THROWS_WITH(set.set_velocity(set.node(rod, 0), {1, 0, 0}),
                    Catch::Contains("rod #0, node #0: a fixed node has no velocity; release it first"));
  CHECK_THROWS_WITH(set.place(set.node(rod, 1), {nan, 0, 0}, Quat::Identity()),
                    Catch::Contains("rod #0, node #1: position"));
  CHECK_THROWS_WITH(set.anchor_at(rod, {0, 0, 5}), Catch::Contains("is not on rod #0, whose line passes"));
  set.remove(rod);
  CHECK_THROWS_WITH(set.node_count(rod), Catch::Contains("rod #0 was removed; its handle is stale"));
}

TEST_CASE("an anchor on a segment moves with the point of the rod it was put on") {
  Rods set;
  const auto rod = set.add(bent_rod());
  const Vec3 a = set.position(set.node(rod, 2)), b = set.position(set.node(rod, 3));
  const Anchor anchor = set.anchor_at(rod, 0.75 * a + 0.25 * b);
  CHECK((set.point(anchor) - (0.75 * a + 0.25 * b)).norm() < 1e-15);
  CHECK(!anchor.has_frame);
  // A turn of everything moves it as one of its points; its rows see just that velocity.
  const Vec3 turn(0.3, -0.2, 0.5);
  for (const Index k : set.active())
    set.velocity()[k] = twist<double>(turn.cross(set.position(set.handle(k))), turn);
  const Vec3 point = set.point(anchor), direction = Vec3(2, -1, 2) / 3;
  double u = 0;
  for (int k = 0; k < set.anchor_blocks(anchor); ++k)
    u += set.along(anchor, k, point, direction).dot(set.velocity()[set.anchor_block(anchor, k)]);
  CHECK(std::abs(u - direction.dot(turn.cross(point))) < 1e-15);
  CHECK(std::abs(u) > 0.01);
}

TEST_CASE("the frames of a rod follow the direction of `up`, however long it is written") {
  Rod rod = bent_rod();
  Rods set;
  const auto reference = set.add(rod);
  for (const double length : {1e-200, 1e-7, 1e7, 1e200}) {
    rod.up = {0, 0, length};
    const auto other = set.add(rod);
    for (Index k = 0; k < set.node_count(other); ++k)
      CHECK(set.orientation(set.node(other, k)).angularDistance(set.orientation(set.node(reference, k))) <
            1e-7);
  }
}

TEST_CASE("single precision keeps a rod's forces to its own rounding") {
  RodsF set;
  set.add(bent_rod());
  Rods reference;
  reference.add(bent_rod());
  shake(set, 0.02, 0.5);
  shake(reference, 0.02, 0.5);
  const auto f = elastic_forces(set);
  const auto g = elastic_forces(reference);
  double size = 0, worst = 0;
  for (const Index b : set.active()) {
    size = std::max(size, g[b].norm());
    worst = std::max(worst, (f[b].cast<double>() - g[b]).norm());
  }
  CHECK(size > 1);
  CHECK(
      worst <
      1e-4 *
          size);  // places of 0.4 m to 3e-8 of them, strained by a tenth of 0.16 m: 1e-6, and ten times that
}
