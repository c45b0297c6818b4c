#include <delassus/linear/block_cholesky.hpp>
#include <delassus/linear/factorization.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <utility>
#include <vector>

#include "catch.hpp"

using namespace delassus;

static_assert(Factorization<BlockCholesky<3, double>, 3, double>);
static_assert(Factorization<MultifrontalCholesky<3, double>, 3, double>);
static_assert(Factorization<MultifrontalCholesky<6, float>, 6, float>);

static long allocations = 0;
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc{};
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

/// A graph of nodes in space, and A = Σ over pairs of (e_i − e_j)(e_i − e_j)ᵀ ⊗ K_ij + shift 1: positive for
/// shift > 0.
template <int w>
struct Blocks {
  Index n = 0;
  Pairs pairs;
  std::vector<Vec3> positions;
  std::vector<Mat<w, w>> K;
  double shift = 1;

  void draw(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Mat<w, w> B = Mat<w, w>::NullaryExpr([&] { return draw(random); });
      K.push_back(B * B.transpose());
    }
  }
  template <class F>
  void fill(F& f) const {
    using Block = typename F::Block;
    f.set_zero();
    for (Index i = 0; i < n; ++i) f.add_diagonal(i, shift * Block::Identity());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Block B = K[k].template cast<typename Block::Scalar>();
      f.add_diagonal(pairs[k].first, B);
      f.add_diagonal(pairs[k].second, B);
      f.add_pair(pairs[k].first, pairs[k].second, -B);
    }
  }
  Eigen::SparseMatrix<double> sparse() const {
    std::vector<Eigen::Triplet<double>> t;
    const auto add = [&](Index i, Index j, const Mat<w, w>& B) {
      for (int r = 0; r < w; ++r)
        for (int c = 0; c < w; ++c) t.emplace_back(w * i + r, w * j + c, B(r, c));
    };
    for (Index i = 0; i < n; ++i) add(i, i, shift * Mat<w, w>::Identity());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [i, j] = pairs[k];
      add(i, i, K[k]), add(j, j, K[k]), add(i, j, -K[k]), add(j, i, -K[k].transpose());
    }
    Eigen::SparseMatrix<double> A(w * n, w * n);
    A.setFromTriplets(t.begin(), t.end());
    return A;
  }
};

/// nx × ny × nz nodes, each with its neighbours along the axes and the diagonals of a Kuhn mesh.
template <int w>
Blocks<w> grid(Index nx, Index ny, Index nz, unsigned seed) {
  Blocks<w> g;
  g.n = nx * ny * nz;
  for (Index k = 0; k < nz; ++k)
    for (Index j = 0; j < ny; ++j)
      for (Index i = 0; i < nx; ++i) {
        g.positions.push_back(Vec3(i, j, k));
        for (int d = 1; d < 8; ++d) {
          const Index a = i + d % 2, b = j + d / 2 % 2, c = k + d / 4;
          if (a < nx && b < ny && c < nz) g.pairs.emplace_back(i + nx * (j + ny * k), a + nx * (b + ny * c));
        }
      }
  g.draw(seed);
  return g;
}

/// A random graph: repeats and both orders occur, and parts without any neighbour.
template <int w>
Blocks<w> random_graph(Index n, Index pairs, unsigned seed) {
  Blocks<w> g;
  g.n = n;
  std::mt19937 random(seed);
  std::uniform_int_distribution<Index> pick(0, n - 1);
  while (Index(g.pairs.size()) < pairs) {
    const Index i = pick(random), j = pick(random);
    if (i != j) g.pairs.emplace_back(i, j);
  }
  g.draw(seed);
  return g;
}

/// |A x − b| / |b| of a solve with a random b.
template <int w, class T>
double residual(const Blocks<w>& g, const MultifrontalCholesky<w, T>& f) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<Vec<w, T>> x(g.n);
  Eigen::VectorXd b(w * g.n), solved(w * g.n);
  for (Index i = 0; i < g.n; ++i) x[i] = Vec<w, T>::NullaryExpr([&] { return T(draw(random)); });
  for (Index i = 0; i < g.n; ++i) b.segment<w>(w * i) = x[i].template cast<double>();
  f.solve(x);
  for (Index i = 0; i < g.n; ++i) solved.segment<w>(w * i) = x[i].template cast<double>();
  return (g.sparse() * solved - b).norm() / b.norm();
}

}  // namespace

// |A| / shift < 200 here, so a backward stable solve leaves |A x − b| ≤ c n ε |A| |x| ≤ 200 c n ε |b|; the
// sums of a front are far shorter than n, and 1e-12 = 4500 ε holds with c n ~ 20.
TEST_CASE(
    "the multifrontal factor solves what was put in: grids and random graphs, with and without positions") {
  for (const auto& g :
       {grid<3>(1, 1, 1, 1), grid<3>(2, 3, 2, 2), grid<3>(6, 5, 9, 3), grid<3>(30, 1, 1, 4),
        random_graph<3>(40, 60, 5), random_graph<3>(150, 100, 6), random_graph<3>(60, 900, 7)}) {
    MultifrontalCholesky<3, double> f;
    f.analyse(g.n, g.pairs);
    g.fill(f);
    REQUIRE(f.factor());
    CHECK(residual(g, f) < 1e-12);
    if (g.positions.empty()) continue;
    f.analyse(g.n, g.pairs, g.positions);
    g.fill(f);
    REQUIRE(f.factor());
    CHECK(residual(g, f) < 1e-12);
  }
  const auto six = grid<6>(4, 4, 5, 8);
  MultifrontalCholesky<6, double> f;
  f.analyse(six.n, six.pairs, six.positions);
  six.fill(f);
  REQUIRE(f.factor());
  CHECK(residual(six, f) < 1e-12);
}

TEST_CASE("the multifrontal solution is that of Eigen's LDLT") {
  const auto g = grid<3>(7, 6, 8, 11);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(g.sparse());
  std::vector<Vec3> x(g.n, Vec3(1, -2, 3));
  const Eigen::VectorXd y = ldlt.solve(Eigen::VectorXd(Vec3(1, -2, 3).replicate(g.n, 1)));
  f.solve(x);
  // cond A < 200: both are within 200 c ε of the solution.
  for (Index i = 0; i < g.n; ++i) CHECK((x[i] - y.segment<3>(3 * i)).norm() < 1e-12 * y.norm());
}

TEST_CASE("a float factor solves to single precision") {
  const auto g = grid<3>(6, 5, 9, 3);
  MultifrontalCholesky<3, float> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  CHECK(residual(g, f) < 5e-4);   // 4500 ε again
  CHECK(residual(g, f) > 1e-12);  // it was float
}

TEST_CASE("the compliance of nodes is their part of the inverse") {
  const auto g = grid<3>(5, 4, 6, 21);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  g.fill(f);
  REQUIRE(f.factor());
  const Eigen::MatrixXd inverse = Eigen::MatrixXd(g.sparse()).inverse();
  for (const std::vector<Index>& nodes : {std::vector<Index>{17}, {119, 0, 60, 61, 3}, {5, 4, 3, 2, 1, 0}}) {
    const int m = 3 * int(nodes.size());
    std::vector<double> C(m * m);
    f.compliance(nodes, C);
    for (int a = 0; a < m; ++a)
      for (int b = 0; b < m; ++b) {
        const double exact = inverse(3 * nodes[a / 3] + a % 3, 3 * nodes[b / 3] + b % 3);
        CHECK(std::abs(C[a + b * m] - exact) < 1e-12);  // |A⁻¹| ≤ 1 / shift = 1
      }
  }
}

TEST_CASE(
    "a matrix that is not positive definite is refused, wherever it fails, and the next good one is "
    "factored") {
  const auto g = grid<3>(4, 4, 4, 31);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  for (const Index node : {0, 21, 42, 63})
    for (const double bad :
         {-1e6, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      g.fill(f);
      f.add_diagonal(node, bad * Mat3::Identity());
      CHECK_FALSE(f.factor());
    }
  g.fill(f);
  REQUIRE(f.factor());
  CHECK(residual(g, f) < 1e-12);
}

TEST_CASE("factoring, solving and compliances allocate nothing the second time") {
  const auto g = grid<3>(9, 9, 9, 41);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  std::vector<Vec3> x(g.n, Vec3(1, 2, 3));
  const std::vector<Index> nodes{1, 5, 700, 300};
  std::vector<double> C(144);
  long before = 0;
  for (int n = 0; n < 2; ++n) {
    before = allocations;
    g.fill(f);
    f.factor();
    f.solve(x);
    f.compliance(nodes, C);
  }
  CHECK(allocations == before);
}

TEST_CASE("nested dissection fills less than the order of numbering") {
  const auto g = grid<3>(12, 12, 12, 51);
  MultifrontalCholesky<3, double> f;
  f.analyse(g.n, g.pairs, g.positions);
  // In the order of numbering every column fills a plane of 144 nodes, but for those of the last plane.
  CHECK(f.size() < std::size_t(9) * (1728 - 144) * 144);
  CHECK(f.size() > std::size_t(9) * 1728);
}
