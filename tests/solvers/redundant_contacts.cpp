// The same contact given k times: λ is no longer unique, the motion that it makes is.
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace redundant_contacts_tests {

using namespace delassus;

namespace {

/// A box of 1 × 1 × 0.4 m and 2 kg on a plane, its four lower corners each given `copies` times.
struct Box {
  static constexpr double mass = 2;
  using Velocity = std::array<double, 6>;  ///< linear, then angular
  Velocity inverse{1 / mass, 1 / mass, 1 / mass, 12 / (mass * 1.16), 12 / (mass * 1.16), 12 / (mass * 2)};
  std::vector<std::array<Velocity, 3>> H;  ///< rows (n, t₁, t₂) of each contact

  explicit Box(int copies) {
    for (int k = 0; k < 4 * copies; ++k) {
      const double x = k % 2 ? 0.5 : -0.5, y = k / 2 % 2 ? 0.5 : -0.5, z = -0.2;
      // e · (v + ω × r) = (e, r × e) · (v, ω) for e = z, x, y.
      H.push_back({Velocity{0, 0, 1, y, -x, 0}, Velocity{1, 0, 0, 0, z, -y}, Velocity{0, 1, 0, -z, 0, x}});
    }
  }

  FrictionProblem problem(const Velocity& free, double friction) const {
    std::vector<Vec3> d;
    std::vector<GivenBlock> blocks;
    for (std::size_t i = 0; i < H.size(); ++i) {
      d.push_back(Vec3::Zero());
      for (int r = 0; r < 3; ++r)
        for (std::size_t b = 0; b < 6; ++b) d.back()[r] += H[i][std::size_t(r)][b] * free[b];
      for (std::size_t j = 0; j < H.size(); ++j) {
        GivenBlock W{Index(i), Index(j), Mat3::Zero()};
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c)
            for (std::size_t b = 0; b < 6; ++b)
              W.block(r, c) += H[i][std::size_t(r)][b] * inverse[b] * H[j][std::size_t(c)][b];
        blocks.push_back(W);
      }
    }
    return make_friction_problem(std::vector<double>(H.size(), friction), d, blocks);
  }

  /// v + M⁻¹ Hᵀ λ.
  Velocity motion(Velocity v, std::span<const Vec3> lambda) const {
    for (std::size_t i = 0; i < H.size(); ++i)
      for (int r = 0; r < 3; ++r)
        for (std::size_t b = 0; b < 6; ++b) v[b] += inverse[b] * H[i][std::size_t(r)][b] * lambda[i][r];
    return v;
  }
};

constexpr int many[] = {1, 2, 3, 5, 10, 20, 50};

Box::Velocity solved_motion(int copies, const Box::Velocity& free, double friction) {
  const Box box(copies);
  FrictionProblem p = box.problem(free, friction);
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 100000});
  CAPTURE(copies, r.sweeps, r.measure.residual);
  REQUIRE(r.status != Status::max_iterations);  // converged, or at the floor of rounding
  double largest = 0;
  for (const Vec3& x : p.rows.pool<0>().lambda) largest = std::max(largest, x.norm());
  REQUIRE(largest <
          10);  // no impulse runs off where λ is not unique: all that arrives is of the order of 2 kg × 1 m/s
  return box.motion(free, p.rows.pool<0>().lambda);
}

double distance(const Box::Velocity& a, const Box::Velocity& b) {
  double most = 0;
  for (std::size_t k = 0; k < 6; ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

}  // namespace

// Rows that hold have u = F, so that their motion is as exact as the residual, 1e-13 of 1 m/s times the
// square root of 200 contacts.
TEST_CASE("a contact that sticks given up to 50 times changes the motion by less than 1e-10") {
  const Box::Velocity free{0.3, -0.2, -1, 0.02, -0.05, 0.1};
  for (const int copies : many)
    REQUIRE(distance(solved_motion(copies, free, 0.9), Box::Velocity{}) < 1e-10);  // it stands
}

TEST_CASE("a frictionless contact given up to 50 times changes the motion by less than 1e-10") {
  // Tips over: two corners hold and two leave.
  const Box::Velocity free{0.3, -0.2, -0.2, 0, 4, 0.1};
  const Box::Velocity once = solved_motion(1, free, 0);
  REQUIRE(once[4] > 0.1);
  REQUIRE(std::abs(once[2]) > 0.01);
  for (const int copies : many) REQUIRE(distance(solved_motion(copies, free, 0), once) < 1e-10);
}

}  // namespace redundant_contacts_tests
