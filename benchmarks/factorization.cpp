// Factor, solve and node compliance of the stiffness-like matrix of a tetrahedral box: the multifrontal
// factorization against Eigen's SimplicialLDLT (minimum degree), same matrix, same run, CPU time of one
// thread. Argument: nodes along each edge.
#include <delassus/linear/multifrontal_cholesky.hpp>

#include <benchmark/benchmark.h>
#include <Eigen/SparseCholesky>

#include <random>
#include <utility>
#include <vector>

using namespace delassus;

namespace {

/// n³ nodes, neighbours as in a Kuhn mesh; A = 1 + Σ (e_i − e_j)(e_i − e_j)ᵀ ⊗ K, K random and positive.
struct Box {
  Index nodes;
  std::vector<std::pair<Index, Index>> pairs;
  std::vector<Vec3> positions;
  std::vector<Mat3> K;

  explicit Box(Index n) : nodes(n * n * n) {
    for (Index k = 0; k < n; ++k)
      for (Index j = 0; j < n; ++j)
        for (Index i = 0; i < n; ++i) {
          positions.push_back(Vec3(i, j, k));
          for (int d = 1; d < 8; ++d) {
            const Index a = i + d % 2, b = j + d / 2 % 2, c = k + d / 4;
            if (a < n && b < n && c < n) pairs.emplace_back(i + n * (j + n * k), a + n * (b + n * c));
          }
        }
    std::mt19937 random(1);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Mat3 B = Mat3::NullaryExpr([&] { return draw(random); });
      K.push_back(B * B.transpose());
    }
  }
  Eigen::SparseMatrix<double> sparse() const {
    std::vector<Eigen::Triplet<double>> t;
    const auto add = [&](Index i, Index j, const Mat3& B) {
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) t.emplace_back(3 * i + r, 3 * j + c, B(r, c));
    };
    for (Index i = 0; i < nodes; ++i) add(i, i, Mat3::Identity());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [i, j] = pairs[k];
      add(i, i, K[k]), add(j, j, K[k]), add(i, j, -K[k]), add(j, i, -K[k]);
    }
    Eigen::SparseMatrix<double> A(3 * nodes, 3 * nodes);
    A.setFromTriplets(t.begin(), t.end());
    return A;
  }
};

template <class T>
struct Multifrontal {
  Box box;
  MultifrontalCholesky<3, T> factor;
  explicit Multifrontal(Index n) : box(n) {
    factor.analyse(box.nodes, box.pairs, box.positions);
    factor.set_zero();
    for (Index i = 0; i < box.nodes; ++i) factor.add_diagonal(i, Mat<3, 3, T>::Identity());
    for (std::size_t k = 0; k < box.pairs.size(); ++k) {
      const Mat<3, 3, T> K = box.K[k].template cast<T>();
      factor.add_diagonal(box.pairs[k].first, K);
      factor.add_diagonal(box.pairs[k].second, K);
      factor.add_pair(box.pairs[k].first, box.pairs[k].second, -K);
    }
    factor.factor();
  }
};

void eigen_factor(benchmark::State& state) {
  const auto A = Box(Index(state.range(0))).sparse();
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt;
  ldlt.analyzePattern(A);
  for (auto _ : state) ldlt.factorize(A);
}
void eigen_solve(benchmark::State& state) {
  const auto A = Box(Index(state.range(0))).sparse();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(A);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(A.rows());
  for (auto _ : state) x = ldlt.solve(x).eval();
}
template <class T>
void multifrontal_factor(benchmark::State& state) {
  Multifrontal<T> m(Index(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(m.factor.factor());
  state.counters["numbers in L"] = double(m.factor.size());
}
template <class T>
void multifrontal_solve(benchmark::State& state) {
  const Multifrontal<T> m(Index(state.range(0)));
  std::vector<Vec<3, T>> x(m.box.nodes, Vec<3, T>::Ones());
  for (auto _ : state) m.factor.solve(x);
}
/// Fifty nodes of one face.
template <class T>
void multifrontal_compliance(benchmark::State& state) {
  const Index n = Index(state.range(0));
  const Multifrontal<T> m(n);
  std::vector<Index> nodes;
  for (Index k = 0; k < 50; ++k) nodes.push_back(k % 8 + n * (k / 8));
  std::vector<T> C(150 * 150);
  for (auto _ : state) m.factor.compliance(nodes, C);
}

}  // namespace

// 512, 2 744 and 10 648 nodes.
BENCHMARK(eigen_factor)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(multifrontal_factor<double>)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(multifrontal_factor<float>)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(eigen_solve)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(multifrontal_solve<double>)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(multifrontal_solve<float>)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
BENCHMARK(multifrontal_compliance<double>)->Arg(8)->Arg(14)->Arg(22)->Unit(benchmark::kMillisecond);
