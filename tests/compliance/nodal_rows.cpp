#include <delassus/compliance/assembled.hpp>

#include <Eigen/Dense>

#include <type_traits>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "compliance/coupled_grid.hpp"

namespace nodal_rows_tests {

using namespace coupled_grid;

static_assert(NodeCompliantSet<CompliantGrids>);
static_assert(!NodeCompliantSet<Grids>);

namespace {

using Rows = RowSystem<double, Widths<3>, 3, 1>;  // contacts of 3 rows, and joints of 1
using W = AssembledCompliance::Operator<Rows>;

/// Contacts on one to four nodes, of one body or of two, and joints of two nodes.
Rows draw_rows(const Grids& set, Index contacts, Index joints) {
  Rows rows;
  rows.pool<0>().reset(contacts);
  rows.pool<1>().reset(joints);
  std::mt19937 random(17);
  const auto node = [&](Index body) {
    return set.first[body] + Index(random() % unsigned(set.first[body + 1] - set.first[body]));
  };
  const Index bodies = Index(set.factor.size());
  for (Index i = 0; i < contacts; ++i) {
    std::vector<Index> nodes;
    const Index a = i % bodies, b = i % 5 == 4 ? (i + 1) % bodies : a;  // now and then between two bodies
    for (Index k = 0; k <= i % 4; ++k) nodes.push_back(node(k % 2 ? b : a));
    add_item(rows.pool<0>(), nodes, random);
  }
  for (Index i = 0; i < joints; ++i)
    add_item(rows.pool<1>(), std::vector<Index>{node(i % bodies), node((i + i / 2) % bodies)}, random);
  return rows;
}

/// W as a dense matrix, rows of pool 0 first.
Eigen::MatrixXd dense(const W& op, const Rows& rows) {
  const int first[] = {0, 3 * rows.pool<0>().items()};
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows.row_count(), rows.row_count());
  for_each_index<2>([&](auto a) {
    constexpr int Ra = Rows::rows_of<a>;
    for (Index i = 0; i < rows.pool<a>().items(); ++i) {
      all.block<Ra, Ra>(first[a] + Ra * i, first[a] + Ra * i) = op.diagonal<a>(i);
      for_each_index<2>([&](auto b) {
        constexpr int Rb = Rows::rows_of<b>;
        const auto& blocks = op.blocks<a, b>();
        for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e)
          all.block<Ra, Rb>(first[a] + Ra * i, first[b] + Rb * blocks.column[e]) = blocks.block[e];
      });
    }
  });
  return all;
}

template <class Set>
Alone<Set> two_bodies() {
  Alone<Set> world;
  world.set.add(block_graphs::grid<3>(4, 5, 6, 31));
  world.set.add(block_graphs::grid<3>(5, 3, 4, 32));
  return world;
}

/// Largest |H| of a row, in the sense |H_ij| ≤ 1: 4 nodes of 3 numbers.
constexpr double row_norm_squared = 12;

}  // namespace

// |A⁻¹| ≤ 1 and cond A < 200 (block_graphs.hpp), so C is right to 200 c ε, c some tens, and |W_ij| ≤ |H_i|
// |H_j| ≤ 12.
TEST_CASE("W by the compliance of nodes is W by whole solves, row by row") {
  const auto world = two_bodies<CompliantGrids>();
  const auto plain = two_bodies<Grids>();
  Rows rows = draw_rows(world.set, 23, 7), same = rows;
  W nodal, whole;
  nodal.build(world, rows);
  whole.build(plain, same);
  const Eigen::MatrixXd A = dense(nodal, rows), B = dense(whole, same);
  CHECK((A - B).cwiseAbs().maxCoeff() < 1e-10 * row_norm_squared);
  CHECK(B.cwiseAbs().maxCoeff() > 1e-2);

  SECTION("symmetric and positive semidefinite") {
    CHECK((A - A.transpose()).cwiseAbs().maxCoeff() < 1e-12 * row_norm_squared);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
    CHECK(values.minCoeff() > -1e-12 * values.maxCoeff());
    CHECK(values.maxCoeff() < 1e3);
  }

  SECTION("H dv = W lambda, where dv is a whole solve with the impulses") {
    std::vector<Vec3> dv(world.set.blocks(), Vec3::Zero());
    Eigen::VectorXd lambda = Eigen::VectorXd::LinSpaced(rows.row_count(), -1, 2), u(rows.row_count());
    const int first[] = {0, 3 * rows.pool<0>().items()};
    const auto each_entry = [&](auto&& f) {
      for_each_index<2>([&](auto p) {
        const auto& blocks = inner::part<0>(rows.pool<p>().sets);
        for (Index i = 0; i < rows.pool<p>().items(); ++i)
          for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
            f(blocks.H[e], blocks.block[e], first[p] + Rows::rows_of<p> * i);
      });
    };
    each_entry(
        [&](const auto& H, Index b, int at) { dv[b] += H.transpose() * lambda.segment(at, H.rows()); });
    world.set.solve(dv);
    u.setZero();
    each_entry([&](const auto& H, Index b, int at) { u.segment(at, H.rows()) += H * dv[b]; });
    CHECK((u - A * lambda).norm() < 1e-10 * u.norm());
    CHECK(u.norm() > 1);
  }
}

TEST_CASE("constraints on bodies that share none have no block in W") {
  const auto world = two_bodies<CompliantGrids>();
  Rows rows;
  rows.pool<0>().reset(4);
  rows.pool<1>().reset(0);
  std::mt19937 random(3);
  for (const Index node : {0, 130, 7, 150})
    add_item(rows.pool<0>(), std::vector<Index>{node, node + 1, node + 2}, random);
  W op;
  op.build(world, rows);
  const auto& blocks = op.blocks<0, 0>();
  REQUIRE(blocks.column == std::vector<Index>{2, 3, 0, 1});
  for (Index i = 0; i < 4; ++i) CHECK(blocks.start[i + 1] - blocks.start[i] == 1);
}

TEST_CASE("rows without entries, and no rows at all, have no W") {
  const auto world = two_bodies<CompliantGrids>();
  Rows rows;
  rows.pool<0>().reset(2);
  rows.pool<1>().reset(0);
  std::mt19937 random(3);
  add_item(rows.pool<0>(), {}, random);
  add_item(rows.pool<0>(), std::vector<Index>{5}, random);
  W op;
  op.build(world, rows);
  CHECK(op.diagonal<0>(0).isZero());
  CHECK(op.diagonal<0>(1).norm() > 1e-3);
  CHECK(op.blocks<0, 0>().column.empty());
  rows.reset();
  op.build(world, rows);
  CHECK(op.blocks<0, 0>().column.empty());
}

}  // namespace nodal_rows_tests
