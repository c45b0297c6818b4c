// Closed forms of beams, met by rods.
#include <delassus/bodies/world.hpp>
#include <delassus/fem/find_rest.hpp>
#include <delassus/fem/rods.hpp>

#include "catch.hpp"
#include "rod_scenes.hpp"

using namespace delassus;
using namespace rod_scenes;

TEST_CASE("the tip of a cantilever goes where Timoshenko's beam goes, whatever the number of segments") {
  for (const Index n : {1, 2, 7}) {
    Needle s(n);
    const double P = 1e-6 * s.EI, G = Needle::young / 2.6;
    s.set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec<6>> x(s.set.blocks(), Vec<6>::Zero());
    x[n][1] = P;
    x[n][2] = -2 * P;
    s.set.solve(x);
    const double expected = P / (3 * s.EI) + P / (s.section.shear * G * s.section.area);
    CHECK(std::abs(x[n][1] / expected - 1) < 1e-10);  // κ(K) of seven segments is 1e6
    CHECK(std::abs(x[n][2] / expected + 2) < 2e-10);
  }
}

TEST_CASE("a short stubby cantilever yields by shear as Timoshenko says") {
  Rods set;
  set.gravity.setZero();
  const RodSection section = rectangular_section(0.2, 0.1);
  const auto rod = set.add({.points = straight_line({0, 0, 0}, {0.1, 0, 0}, 3),
                            .section = section,
                            .young = 1e6,
                            .up = {0, 1, 0}});
  set.fix(set.node(rod, 0));
  set.factor({.mass = 0, .stiffness = 1});
  std::vector<Vec<6>> x(set.blocks(), Vec<6>::Zero());
  x[3][1] = x[3][2] = 1;
  set.solve(x);
  const double sheared = 0.1 / (5.0 / 6 * 1e6 / 2.6 * 0.02);
  const double along_y = sheared + 1e-3 / (3 * 1e6 * section.second_z),
               along_z = sheared + 1e-3 / (3 * 1e6 * section.second_y);
  CHECK(std::abs(x[3][1] / along_y - 1) < 1e-12);
  CHECK(std::abs(x[3][2] / along_z - 1) < 1e-12);
  CHECK(sheared > 0.5 * along_y);  // it is the larger part
}

TEST_CASE("a needle under a load that bends it far lies on the elastica to one percent") {
  // (w, u)/L of the inextensible elastica at P L²/EI. Of an error the share 1/(n²) of the segments, and P/(κ
  // G A) of shear and P/(E A) of stretch, both P r²/4EI and its like: 2e-3 at the heaviest load.
  const double known[][3] = {{1, 0.301720773799814, 0.0564332362833769},
                             {2, 0.493457480396712, 0.160641720825167},
                             {5, 0.713791523611913, 0.38762836072443},
                             {10, 0.810609024880296, 0.554995597753751}};
  for (const auto& [load, w, u] : known) {
    Needle s(20);
    s.set.apply_force(s.tip(), {0, 0, -load * s.EI});
    const RestReport report = find_rest(s.set);
    CHECK(report.status == Status::converged);
    const Vec3 tip = s.set.position(s.tip());
    CAPTURE(load);
    CHECK(std::abs(-tip[2] - w) < 1e-3);
    CHECK(std::abs(1 - tip[0] - u) < 1e-3);
    CHECK(std::abs(tip[1]) < 1e-12);
  }
}

TEST_CASE("the moment 2 pi EI / L closes the circle") {
  for (const Index n : {8, 20}) {
    Needle s(n);
    s.set.apply_torque(s.tip(), {0, 2 * M_PI * s.EI, 0});
    const RestReport report = find_rest(s.set, {.max_iterations = 200});
    CHECK(report.status == Status::converged);
    // Pure bending is exact: n equal turns of 2π/n.
    CHECK(s.set.position(s.tip()).norm() < 1e-9);
    for (Index k = 1; k <= n; ++k) {
      const Quat between =
          s.set.orientation(s.set.node(s.rod, k - 1)).conjugate() * s.set.orientation(s.set.node(s.rod, k));
      CHECK(std::abs(logarithm<double>(between)[1] - 2 * M_PI / double(n)) < 1e-9);
    }
  }
}

TEST_CASE(
    "torsion: T = G J theta / L, J of a square 0.1406 of its side to the fourth, to 90 degrees and on") {
  const RodSection square = rectangular_section(0.02, 0.02);
  CHECK(std::abs(square.torsion / 1.6e-7 - 0.140577014955154) < 1e-12);
  double last = 0;
  for (const double degrees : {1.0, 30.0, 90.0, 360.0}) {
    Rods set;
    set.gravity.setZero();
    const auto rod =
        set.add({.points = straight_line({0, 0, 0}, {1, 0, 0}, 8), .section = square, .young = 1e6});
    const double angle = degrees * M_PI / 180;
    for (Index k = 0; k <= 8; ++k) {
      const auto node = set.node(rod, k);
      set.place(node, set.position(node),
                exponential<double>(Vec3(angle * double(k) / 8, 0, 0)) * set.orientation(node));
    }
    const auto f = elastic_forces(set);
    const double torque = 1e6 / 2.6 * square.torsion * angle;
    CHECK(std::abs(f[0][3] / torque - 1) < 1e-12);
    CHECK(std::abs(f[8][3] / torque + 1) < 1e-12);
    for (Index k = 0; k <= 8; ++k) CHECK(linear_part(f[k]).norm() < 1e-12);  // no force along, nor aside
    CHECK(set.elastic_energy() > last);
    CHECK(std::abs(set.elastic_energy() / (0.5 * torque * angle) - 1) < 1e-12);
    last = set.elastic_energy();
  }
}

TEST_CASE(
    "the first frequency of a clamped rod is Euler's, and its error falls with the square of the segments") {
  // ω = 1.8751² √(EI/ρA L⁴); shear and rotary inertia take 1e-4 of it at r/L = 1 %.
  const auto frequency = [](Index n) {
    Needle s(n);
    s.set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec<6>> v(s.set.blocks(), Vec<6>::Zero());
    v[n][2] = 1;
    double omega2 = 0;
    for (int i = 0; i < 8; ++i) {  // the second frequency is six times the first: 1/36 an iteration
      auto y = v;
      double before = 0, after = 0, size = 0;
      for (const Index b : s.set.active())
        y[b] = s.set.moves(b) ? s.set.momentum(b, v[b]) : Vec<6>(Vec<6>::Zero());
      const auto z = y;
      s.set.solve(y);
      for (const Index b : s.set.active()) {
        before += v[b].dot(z[b]);
        after += y[b].dot(z[b]);
        size = std::max(size, y[b].norm());
      }
      omega2 = before / after;
      for (const Index b : s.set.active()) v[b] = y[b] / size;
    }
    return std::sqrt(omega2);
  };
  const Needle s(1);
  const double euler = 1.87510406871196 * 1.87510406871196 * std::sqrt(s.EI / (1000 * s.section.area));
  const double coarse = frequency(10) / euler - 1, fine = frequency(20) / euler - 1;
  CHECK(std::abs(coarse) < 0.01);
  CHECK(std::abs(fine) < 0.0025);
  CHECK(std::abs(coarse / fine - 4) < 0.6);  // order two, and the 1e-4 that stays
}

TEST_CASE("a needle stands below Euler's load and buckles above it") {
  for (const double share : {0.9, 1.2}) {
    Needle s(20);
    const double P = share * M_PI * M_PI * s.EI / 4;
    s.set.apply_force(s.tip(), {-P, 0, 1e-5 * P});
    const RestReport report = find_rest(s.set, {.max_iterations = 1000});
    CHECK(report.status == Status::converged);
    const double aside = s.set.position(s.tip())[2];
    if (share < 1)
      CHECK((aside > 0 && aside < 1e-3));  // 1e-5 P L³/3EI times 1/(1 − 0.9): some 1e-4
    else
      CHECK(aside > 0.5);
  }
}
