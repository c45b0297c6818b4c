#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/linear/node_compliance.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <numeric>
#include <vector>

#include "catch.hpp"
#include "linear/block_graphs.hpp"

namespace node_compliance_tests {

using namespace delassus;
using namespace block_graphs;

namespace {

template <int w, class T>
MultifrontalCholesky<w, T> factored(const Blocks<w>& g) {
  MultifrontalCholesky<w, T> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  return f;
}

template <int w, class T>
Eigen::MatrixXd compliance(const MultifrontalCholesky<w, T>& f, const std::vector<Index>& nodes) {
  const int m = w * int(nodes.size());
  std::vector<T> C(m * m, T(7));
  NodeCompliance<w, T> compliance;
  compliance.find(f, nodes, C);
  return Eigen::Map<Eigen::Matrix<T, -1, -1>>(C.data(), m, m).template cast<double>();
}

/// The same by whole solves, one a column.
template <int w>
Eigen::MatrixXd by_solves(const MultifrontalCholesky<w, double>& f, const std::vector<Index>& nodes) {
  const int m = w * int(nodes.size());
  Eigen::MatrixXd C(m, m);
  for (int j = 0; j < m; ++j) {
    std::vector<Vec<w, double>> x(f.blocks(), Vec<w, double>::Zero());
    x[nodes[j / w]][j % w] = 1;
    f.solve(x);
    for (int i = 0; i < m; ++i) C(i, j) = x[nodes[i / w]][i % w];
  }
  return C;
}

/// Half of the nodes, in no order.
std::vector<Index> scattered(Index n) {
  std::vector<Index> nodes(n);
  std::iota(nodes.begin(), nodes.end(), 0);
  std::shuffle(nodes.begin(), nodes.end(), std::mt19937(3));
  nodes.resize(n / 2);
  return nodes;
}

}  // namespace

// A ≥ shift, so |A⁻¹| ≤ 1, and cond A < 200: either way is within 200 c ε of the inverse, c some tens.
TEST_CASE(
    "the compliance of nodes is that of whole solves, symmetric and positive, for 3 and 6 numbers a node") {
  const auto check = [](const auto& g, const auto& f, const std::vector<Index>& nodes) {
    const Eigen::MatrixXd C = compliance(f, nodes);
    CHECK((C - by_solves(f, nodes)).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(C == C.transpose());
    // The eigenvalues of a part of A⁻¹ lie between those of A⁻¹: 1/200 and 1.
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C).eigenvalues();
    CHECK(values.minCoeff() > 1. / 200);
    CHECK(values.maxCoeff() < 1 / g.shift + 1e-12);
  };
  const auto three = grid<3>(6, 5, 7, 21);
  const auto f = factored<3, double>(three);
  for (const auto& nodes : {std::vector<Index>{100}, {0, 1, 2, 3}, {209, 0, 104}, scattered(three.n)})
    check(three, f, nodes);
  const auto six = grid<6>(4, 3, 4, 22);
  check(six, factored<6, double>(six), scattered(six.n));
}

TEST_CASE("a float factor gives the compliance in single precision") {
  const auto g = grid<3>(6, 5, 7, 21);
  const auto nodes = scattered(g.n);
  const Eigen::MatrixXd C = compliance(factored<3, double>(g), nodes);
  const double error = (compliance(factored<3, float>(g), nodes) - C).cwiseAbs().maxCoeff();
  CHECK(error < 200 * 30 * 6e-8);
  CHECK(error > 1e-12);  // it was float
}

TEST_CASE("the order of the nodes orders the compliance") {
  const auto g = grid<3>(5, 5, 5, 23);
  const std::vector<Index> nodes{62, 3, 124, 17}, turned{17, 124, 3, 62};
  const auto f = factored<3, double>(g);
  const Eigen::MatrixXd C = compliance(f, nodes), D = compliance(f, turned);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) CHECK(D.block<3, 3>(3 * a, 3 * b) == C.block<3, 3>(9 - 3 * a, 9 - 3 * b));
}

}  // namespace node_compliance_tests
