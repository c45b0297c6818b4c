// Frequencies of hexahedra, their own weight, and single precision.
#include "catch.hpp"
#include "hexahedral_scenes.hpp"

using namespace delassus;
using namespace soft_scenes;

TEST_CASE("the first frequency of a cantilever of hexahedra is Euler's, from above, and comes nearer") {
  // E = 1e6 Pa, 1 m × 0.1 m × 0.1 m of 1000 kg/m³: f₁ = 1.8751² √(EI/ρA L⁴)/2π = 0.5108 Hz; Timoshenko's is
  // 0.8 % lower.
  double last = 0.1;
  for (const Index s : {2, 4}) {
    HexahedralFem<Linear> set;
    set.gravity.setZero();
    const auto beam = set.add({.mesh = hexahedral_box({1, 0.1, 0.1}, {5 * s, s, s}),
                               .elasticity = {.young = 1e6, .poisson = 0.3},
                               .density = 1000});
    set.fix(beam, [](const Vec3& x) { return x[0] < 1e-9; });
    set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec3> v(set.blocks(), Vec3::Zero());
    for (Index b = 0; b < set.blocks(); ++b)
      if (set.moves(b)) v[b][2] = set.position(set.handle(b))[0];
    // The second of its kind is six times the first: 1/36 an iteration.
    const double error = std::abs(lowest_frequency(set, v, 8) / (2 * M_PI) / 0.510835 - 1);
    CAPTURE(s, error);
    CHECK(error < 0.02);
    CHECK(error < last);
    last = error;
  }
}

TEST_CASE("a column of hexahedra under its own weight shortens by rho g L^2 / 2E, in single precision too") {
  const double E = 1e6, rho = 1000, g = 9.81;
  const auto sag = [&]<class T>(T) {
    HexahedralFem<Linear, T> set;
    const auto column = set.add({.mesh = hexahedral_box({0.2, 0.2, 1}, {1, 1, 8}),
                                 .elasticity = {.young = E, .poisson = 0},
                                 .density = rho});
    set.fix(column, [](const Vec3& x) { return x[2] < 1e-6; });
    set.factor({.mass = 0, .stiffness = 1});
    std::vector<Vec<3, T>> x(set.blocks(), Vec<3, T>::Zero());
    set.add_forces(x);
    set.solve(x);
    return -double(x.back()[2]);
  };
  // Lumped loads are exact at the nodes: the top moves by ρ g L²/2E.
  CHECK(std::abs(sag(1.0) / (rho * g / (2 * E)) - 1) < 1e-10);
  CHECK(std::abs(sag(1.0f) / (rho * g / (2 * E)) - 1) < 1e-3);  // κ(K) = 1e3 times 6e-8, and ten times that
}
