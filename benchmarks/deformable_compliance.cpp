// Also built with: -march=native
//
// W = H A⁻¹ Hᵀ of contacts on a soft box, and the factorization it needs. Each against another way, turn by turn
// in one run; CPU time of one thread. "The model's way" is the algorithm of the component that is modelled:
// forward substitution of every row of H through all columns of an LDLᵀ factor, then a dot product a pair of
// rows. Arguments: nodes (of tetrahedral_box.hpp), contacts, nodes a contact.
#include <delassus/compliance/assembled.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>

#include "against.hpp"
#include "by_rows.hpp"
#include "tetrahedral_box.hpp"

using namespace delassus;
using namespace tetrahedral_box;

namespace {

using Rows = RowSystem<double, Widths<3>, 3>;

/// One soft body as a builder of W sees it.
struct SoftBox {
  using Scalar = double;
  static constexpr int width = 3;
  Box box;
  MultifrontalCholesky<3, double> factor;

  explicit SoftBox(const Box& b) : box(b) {
    factor.analyse(box.nodes(), box.pairs, box.positions);
    box.fill(factor);
    factor.factor();
  }
  Index blocks() const { return box.nodes(); }
  bool is_coupled() const { return true; }
  Index body_of(Index) const { return 0; }
  bool moves(Index) const { return true; }
  void node_compliance(std::span<const Index> nodes, std::span<double> C) const {
    factor.compliance(nodes, C);
  }
  template <int C>
  Mat<3, C, double> solve_block(Index, const Mat<3, C, double>& x) const {
    return x;
  }
};

struct World {
  SoftBox box;
  template <class F>
  void each(F&& f) const {
    f(box, std::integral_constant<int, 0>{});
  }
};

/// Contacts on a patch of the face z = top: n, t₁, t₂ at a node, or at a point between two to four.
Rows contacts_on(const Box& box, Index contacts, Index nodes) {
  Rows rows;
  rows.pool<0>().reset(contacts);
  auto& blocks = inner::part<0>(rows.pool<0>().sets);
  const Index columns = box.nx - 1;
  for (Index i = 0; i < contacts; ++i) {
    const Index x = i % columns, y = i / columns % (box.ny - 1);
    const Index around[] = {box.node(x, y, box.nz - 1), box.node(x + 1, y, box.nz - 1),
                            box.node(x, y + 1, box.nz - 1), box.node(x + 1, y + 1, box.nz - 1)};
    for (Index k = 0; k < nodes; ++k) {
      Mat3 H;  // normal along z
      H << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      blocks.block.push_back(around[k]);
      blocks.H.push_back(1. / nodes * H);
    }
    rows.pool<0>().close();
  }
  return rows;
}

Eigen::MatrixXd dense(const AssembledCompliance::Operator<Rows>& op, Index contacts) {
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(3 * contacts, 3 * contacts);
  const auto& blocks = op.blocks<0, 0>();
  for (Index i = 0; i < contacts; ++i) {
    W.block<3, 3>(3 * i, 3 * i) = op.diagonal<0>(i);
    for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e)
      W.block<3, 3>(3 * i, 3 * blocks.column[e]) = blocks.block[e];
  }
  return W;
}

void compliance_against_the_models_way(benchmark::State& state) {
  const Index contacts = Index(state.range(1));
  const World world{SoftBox(box_of(Index(state.range(0))))};
  Rows rows = contacts_on(world.box.box, contacts, Index(state.range(2)));
  AssembledCompliance::Operator<Rows> W;
  ByRows theirs(world.box.box.sparse(), rows.row_count());
  theirs.enter<0>(rows.pool<0>(), 0);
  against::run(
      state, [&] { W.build(world, rows); }, [&] { theirs.build(); }, 10);
  state.counters["difference"] =
      (dense(W, contacts) - theirs.W).cwiseAbs().maxCoeff() / theirs.W.cwiseAbs().maxCoeff();
}

void factor_against_eigen_ldlt(benchmark::State& state) {
  SoftBox ours(box_of(Index(state.range(0))));
  const Sparse A = ours.box.sparse();
  Ldlt ldlt;
  ldlt.analyzePattern(A);
  against::run(
      state, [&] { ours.factor.factor(); }, [&] { ldlt.factorize(A); }, state.range(0) > 3000 ? 100 : 10);
}

void of_boxes(benchmark::internal::Benchmark* b) { b->UseManualTime()->Unit(benchmark::kMillisecond); }

}  // namespace

BENCHMARK(compliance_against_the_models_way)
    ->Args({500, 49, 1})
    ->Args({1000, 50, 1})
    ->Args({1000, 81, 1})
    ->Args({3000, 50, 1})
    ->Args({3000, 126, 1})
    ->Args({500, 49, 3})
    ->Args({1000, 50, 3})
    ->Args({3000, 50, 3})
    ->Args({3000, 50, 4})
    ->Args({3000, 126, 3})
    ->Apply(of_boxes);
BENCHMARK(factor_against_eigen_ldlt)->Arg(500)->Arg(1000)->Arg(3000)->Arg(10000)->Apply(of_boxes);
