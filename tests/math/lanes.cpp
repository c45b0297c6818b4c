#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/inner/linear_tetrahedron.hpp>
#include <delassus/fem/inner/node_matrix.hpp>
#include <delassus/math/lanes.hpp>

#include "catch.hpp"

#include <cstring>
#include <random>
#include <vector>

using namespace delassus;

namespace {

/// A few near rotations, stretched, flat, inside out, a line, a point.
std::vector<Mat3> matrices() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<Mat3> all;
  for (int n = 0; n < 60; ++n) {
    Mat3 F = Mat3::NullaryExpr([&] { return draw(random); });
    if (n % 6 == 1) F.col(2) = F.col(0) + F.col(1);
    if (n % 6 == 2) F = F.col(0) * F.row(1).eval();
    if (n % 6 == 3) F = Mat3::Identity() + 1e-3 * F;
    if (n % 12 == 4) F.setZero();
    if (n % 6 == 5) F *= 1e3;
    all.push_back(F);
  }
  while (all.size() % lane_count != 0) all.push_back(Mat3::Identity());
  return all;
}

LaneMatrix lanes_of(const Mat3* F) {
  double numbers[9 * lane_count];
  for (int l = 0; l < lane_count; ++l)
    for (int k = 0; k < 9; ++k) numbers[k * lane_count + l] = F[l].data()[k];
  LaneMatrix M;
  std::memcpy(&M, numbers, sizeof numbers);
  return M;
}
template <class M>
Mat3 lane(const M& nine, int l) {
  double numbers[9 * lane_count];
  std::memcpy(numbers, &nine, sizeof numbers);
  Mat3 one;
  for (int k = 0; k < 9; ++k) one.data()[k] = numbers[k * lane_count + l];
  return one;
}

}  // namespace

// Each turn leaves some ε of |F|, and there are at most 36 of them: 1e-14.
TEST_CASE("singular values of lanes are those of each matrix") {
  const std::vector<Mat3> all = matrices();
  for (std::size_t n = 0; n < all.size(); n += lane_count) {
    const LaneSingularValues f = singular_values(lanes_of(&all[n]));
    for (int l = 0; l < lane_count; ++l) {
      const Mat3 U = lane(f.U, l), V = lane(f.V, l), &F = all[n + l];
      double sigma[3 * lane_count];
      std::memcpy(sigma, &f.sigma, sizeof sigma);
      const Vec3 s(sigma[l], sigma[lane_count + l], sigma[2 * lane_count + l]);
      CAPTURE(n, l, F);
      CHECK((U * s.asDiagonal() * V.transpose() - F).norm() <= 1e-14 * F.norm());
      CHECK((U.transpose() * U - Mat3::Identity()).norm() < 1e-14);
      CHECK((V.transpose() * V - Mat3::Identity()).norm() < 1e-14);
      CHECK(U.determinant() > 0.9);
      CHECK(V.determinant() > 0.9);
      CHECK((s - singular_values(F).sigma).norm() <= 1e-14 * F.norm());
      CHECK(s[0] >= s[1]);
      CHECK(s[1] >= std::abs(s[2]) - 1e-14 * F.norm());
    }
  }
}

// Both go the same way through the same formulas; 2/(σ_i + σ_j) has at most 1e3 in it.
TEST_CASE("a batch of tetrahedra has the forces and the stiffness of each of them") {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> draw(-0.4, 0.4);
  const Corotational material{.young = 1, .poisson = 0.4};
  const TetrahedralMesh unit{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  for (int n = 0; n < 20; ++n) {
    std::vector<inner::LinearTetrahedron> elements;
    std::vector<inner::LinearTetrahedron::Corners> x(lane_count);
    double places[12 * lane_count];
    for (int l = 0; l < lane_count; ++l) {
      elements.emplace_back(unit, 0, Lame(1, 0.4));
      for (int a = 0; a < 4; ++a)
        for (int k = 0; k < 3; ++k) {
          x[l][a][k] = unit.points[a][k] + draw(random);
          places[(3 * a + k) * lane_count + l] = x[l][a][k];
        }
    }
    double numbers[inner::LinearTetrahedron::lane_numbers * lane_count];
    for (int l = 0; l < lane_count; ++l) elements[l].enter_lane({0, 1, 2, 3}, numbers + l);
    const auto state = inner::LinearTetrahedron::lanes_at(material, numbers, places);
    const auto blocks = state.stiffness();
    for (int l = 0; l < lane_count; ++l) {
      const auto one = elements[l].at(material, x[l]);
      const auto K = one.stiffness();
      for (int a = 0; a < 4; ++a) {
        double force[3 * lane_count];
        std::memcpy(force, &state.force[a], sizeof force);
        for (int k = 0; k < 3; ++k) CHECK(std::abs(force[k * lane_count + l] - one.force[a][k]) < 1e-13);
        for (int b = 0; b < 4; ++b) CHECK((lane(blocks.block(a, b), l) - K.block(a, b)).norm() < 1e-11);
      }
    }
  }
}

TEST_CASE("rows of lanes become columns") {
  Lanes rows[lane_count];
  double numbers[lane_count];
  for (int i = 0; i < lane_count; ++i) {
    for (int k = 0; k < lane_count; ++k) numbers[k] = 100 * i + k;
    rows[i] = load_lanes(numbers);
  }
  inner::transpose_lanes(rows);
  for (int i = 0; i < lane_count; ++i) {
    store_lanes(numbers, rows[i]);
    for (int k = 0; k < lane_count; ++k) CHECK(numbers[k] == 100 * k + i);
  }
}
