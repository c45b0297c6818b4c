// The path of smoothed laws where there are no bodies: W alone.
#include <delassus/problems/friction_problem.hpp>

#include "catch.hpp"
#include "path_tests.hpp"

#include <vector>

namespace path_newton_alone_tests {

using namespace path_tests;

namespace {

/// Cubes of 1 m of these masses on each other, from the ground up, four contacts a face, μ = 0.5: W and
/// q = H v of v = (0.1, 0, −0.1) m/s.
FrictionProblem tower(const std::vector<double>& masses) {
  struct Side {
    int body;
    Mat<3, 6> H;
  };
  std::vector<std::vector<Side>> sides;
  std::vector<Vec3> q;
  const Vec3 axes[3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  for (int face = 0; face < int(masses.size()); ++face)
    for (int corner = 0; corner < 4; ++corner) {
      sides.emplace_back();
      q.push_back(face == 0 ? Vec3(-0.1, 0.1, 0) : Vec3::Zero());
      for (int body = std::max(face - 1, 0); body <= face; ++body) {
        const double sign = body == face ? 1 : -1;
        const Vec3 arm(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, -0.5 * sign);
        Side side{body, Mat<3, 6>::Zero()};
        for (int k = 0; k < 3; ++k) {
          const Vec3 turn = arm.cross(axes[k]);
          for (int j = 0; j < 3; ++j) side.H(k, j) = sign * axes[k][j], side.H(k, 3 + j) = sign * turn[j];
        }
        sides.back().push_back(side);
      }
    }
  // W = H A⁻¹ Hᵀ, A = diag(m, m/6).
  std::vector<GivenBlock> blocks;
  for (int i = 0; i < int(sides.size()); ++i)
    for (int j = 0; j < int(sides.size()); ++j) {
      Mat3 W = Mat3::Zero();
      bool is_shared = false;
      for (const Side& a : sides[i])
        for (const Side& b : sides[j]) {
          if (a.body != b.body) continue;
          is_shared = true;
          for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
              for (int x = 0; x < 6; ++x) W(k, l) += (x < 3 ? 1 : 6) / masses[a.body] * a.H(k, x) * b.H(l, x);
        }
      if (is_shared) blocks.push_back({i, j, W});
    }
  return make_friction_problem(std::vector<double>(q.size(), 0.5), q, blocks);
}

}  // namespace

TEST_CASE("the path of smoothed laws leads to Coulomb's law without a sweep, in contact space") {
  for (const double heavy : {1.0, 1e3}) {
    FrictionProblem p = tower({1, 1, heavy});
    check_solved(p, solve(p, path_alone));
  }
}

TEST_CASE(
    "the path stops before contacts without friction where there are no bodies, and sweeps solve them") {
  FrictionProblem p = tower({1, 1});
  for (auto& item : p.laws.pool<0>().items) item.parameters.friction = 0;
  const SolveReport r = solve(p, PathNewton{.tolerance = 1e-7});
  REQUIRE(r.factorizations == 0);
  REQUIRE(r.status == Status::converged);
  REQUIRE(error(p) <= 1e-7);
  REQUIRE(solve(p, PathNewton{.tolerance = 0, .max_sweeps = 0}).status != Status::converged);
}

TEST_CASE("a problem that is not finite, or empty, is no path") {
  FrictionProblem p = tower({1}), none = tower({});
  p.rows.pool<0>().d[2][1] = std::nan("");
  const SolveReport r = solve(p, PathNewton{});
  REQUIRE(r.status == Status::quarantined);
  REQUIRE(r.factorizations == 0);
  for (const Vec3& x : p.rows.pool<0>().lambda) REQUIRE(x == Vec3::Zero());
  REQUIRE(solve(none, PathNewton{}).status == Status::converged);
}

}  // namespace path_newton_alone_tests
