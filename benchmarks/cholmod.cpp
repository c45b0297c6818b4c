// Needs: cholmod (apt-get install libsuitesparse-dev)
// Also built with: -march=native
//
// Factorization of a soft box and the compliance of nodes of its top, against CHOLMOD's supernodal
// factorization with METIS' order and its solve with many right-hand sides, turn by turn in one run; CPU time
// of one thread, which OpenBLAS is told to keep to. The BLAS is whichever the system has; another one is to
// be told by its own variable. Arguments: nodes (of tetrahedral_box.hpp), touched nodes.
#include <delassus/linear/multifrontal_cholesky.hpp>

#include <cholmod.h>

#include "against.hpp"
#include "tetrahedral_box.hpp"

using namespace delassus;
using namespace tetrahedral_box;

extern "C" void openblas_set_num_threads(int) __attribute__((weak));  // null where the BLAS is another one

namespace {

/// CHOLMOD on the lower triangle of A; its arrays belong to CHOLMOD, but for A's.
struct Cholmod {
  cholmod_common common;
  Eigen::SparseMatrix<double> A;
  cholmod_sparse view{};
  cholmod_factor* L = nullptr;
  cholmod_dense *B = nullptr, *Y = nullptr, *work = nullptr, *more = nullptr;

  explicit Cholmod(const Box& box) : A(box.sparse().triangularView<Eigen::Lower>()) {
    if (openblas_set_num_threads) openblas_set_num_threads(1);
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    common.postorder = 1;
    common.final_ll = 1;
    A.makeCompressed();
    view.nrow = view.ncol = std::size_t(A.rows());
    view.nzmax = std::size_t(A.nonZeros());
    view.p = A.outerIndexPtr(), view.i = A.innerIndexPtr(), view.x = A.valuePtr();
    view.stype = -1, view.itype = CHOLMOD_INT, view.xtype = CHOLMOD_REAL, view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    L = cholmod_analyze(&view, &common);
    factor();
  }
  Cholmod(const Cholmod&) = delete;
  ~Cholmod() {
    for (auto** dense : {&B, &Y, &work, &more}) cholmod_free_dense(dense, &common);
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }
  void factor() { cholmod_factorize(&view, L, &common); }

  /// B = P Sᵀ of some nodes.
  void want(const std::vector<Index>& nodes) {
    const Index m = 3 * Index(nodes.size());
    B = cholmod_zeros(std::size_t(A.rows()), std::size_t(m), CHOLMOD_REAL, &common);
    std::vector<Index> place(std::size_t(A.rows()));
    for (std::size_t k = 0; k < place.size(); ++k)
      place[std::size_t(static_cast<int*>(L->Perm)[k])] = Index(k);
    for (Index j = 0; j < m; ++j)
      static_cast<double*>(B->x)[place[std::size_t(3 * nodes[j / 3] + j % 3)] + std::size_t(A.rows()) * j] =
          1;
  }
  /// C = Yᵀ Y, Y = L⁻¹ B.
  void compliance(Eigen::MatrixXd& C) {
    cholmod_solve2(CHOLMOD_L, L, B, nullptr, &Y, nullptr, &work, &more, &common);
    const Eigen::Map<const Eigen::MatrixXd> y(static_cast<const double*>(Y->x), A.rows(), C.rows());
    C.setZero();
    C.selfadjointView<Eigen::Lower>().rankUpdate(y.transpose());
  }
};

struct Ours {
  Box box;
  MultifrontalCholesky<3, double> f;
  explicit Ours(const Box& b) : box(b) {
    f.analyse(box.nodes(), box.pairs, box.positions);
    box.fill(f);
    f.factor();
  }
};

void factor_against_cholmod(benchmark::State& state) {
  Ours ours(box_of(Index(state.range(0))));
  Cholmod theirs(ours.box);
  against::run(
      state, [&] { ours.f.factor(); }, [&] { theirs.factor(); });
  state.counters["L_ours"] = double(ours.f.size());
  state.counters["L_theirs"] = double(theirs.L->xsize);
}

void compliance_against_cholmod(benchmark::State& state) {
  const Ours ours(box_of(Index(state.range(0))));
  Cholmod theirs(ours.box);
  std::vector<Index> nodes;
  for (Index k = 0; k < state.range(1); ++k)
    nodes.push_back(ours.box.node(k % (ours.box.nx - 1), k / (ours.box.nx - 1), ours.box.nz - 1));
  theirs.want(nodes);
  const Index m = 3 * Index(nodes.size());
  std::vector<double> C(std::size_t(m) * m);
  Eigen::MatrixXd D(m, m);
  against::run(
      state, [&] { ours.f.compliance(nodes, C); }, [&] { theirs.compliance(D); }, 5);
  double difference = 0;
  for (Index j = 0; j < m; ++j)
    for (Index i = j; i < m; ++i)
      difference = std::max(difference, std::abs(C[i + std::size_t(j) * m] - D(i, j)));
  state.counters["difference"] = difference / D.diagonal().maxCoeff();
}

void of_boxes(benchmark::internal::Benchmark* b) { b->UseManualTime()->Unit(benchmark::kMillisecond); }

}  // namespace

BENCHMARK(factor_against_cholmod)->Arg(500)->Arg(1000)->Arg(3000)->Arg(10000)->Apply(of_boxes);
BENCHMARK(compliance_against_cholmod)
    ->Args({500, 49})
    ->Args({1000, 50})
    ->Args({3000, 50})
    ->Args({3000, 126})
    ->Args({10000, 200})
    ->Apply(of_boxes);
