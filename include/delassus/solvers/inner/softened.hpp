/// An island whose rows yield to each other.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/solvers/island_problem.hpp>

#include <utility>

namespace delassus::inner {

/// W + ε diag(w_i 1), w_i = tr(W_ii)/rows. Where rows contradict each other λ is bounded on it, by |d|/ε w, not ten times
/// what stops one of them, and the velocities differ by ε/(1 + ε) of theirs, not a tenth, from those that miss the rows
/// least. Less ε would trade the first for the second, and take more sweeps, √(1/ε) with momentum.
template <class Operator, class Rows>
class SoftenedOperator {
  using T = typename Rows::Scalar;
  static constexpr T share = T(0.105);

 public:
  explicit SoftenedOperator(Operator& W) : W_(W) {}

  template <int p>
  auto diagonal(Index i) const {
    constexpr int R = Rows::template rows_of<p>;
    Mat<R, R, T> own = W_.template diagonal<p>(i);
    const T lift = added<p>(i);
    for (int k = 0; k < R; ++k) own(k, k) += lift;
    return own;
  }
  template <int p>
  auto residual(const Rows& rows, Index i) const {
    Vec<Rows::template rows_of<p>, T> u = W_.template residual<p>(rows, i);
    u += added<p>(i) * rows.template pool<p>().lambda[i];
    return u;
  }
  template <int p>
  void commit(const Rows& rows, Index i, const Vec<Rows::template rows_of<p>, T>& change) {
    W_.template commit<p>(rows, i, change);
  }

 private:
  template <int p>
  T added(Index i) const {
    return share * trace(W_.template diagonal<p>(i)) / T(Rows::template rows_of<p>);
  }
  Operator& W_;
};

/// Room for the operator, made before the island that refers to it.
template <class Problem>
struct SoftenedRoom {
  SoftenedOperator<typename Problem::OperatorType, typename Problem::RowsType> softened;
};
template <class Problem>
using SoftenedIsland = decltype(std::declval<const Problem&>().with(
    std::declval<decltype(SoftenedRoom<Problem>::softened)&>(), std::declval<const typename Problem::GroupsType&>()));

/// The island on that operator, begun from λ = 0, with the time of the whole; nobody hears of its sweeps.
template <class Problem>
class Softened : private SoftenedRoom<Problem>, public SoftenedIsland<Problem> {
 public:
  explicit Softened(Problem& whole)
      : SoftenedRoom<Problem>{decltype(SoftenedRoom<Problem>::softened)(whole.compliance())},
        SoftenedIsland<Problem>(whole.with(this->softened, whole.groups())),
        whole_(whole) {
    this->each([&](auto p, Index i) { this->template prepare<p>(i, this->softened.template diagonal<p>(i)); });
    this->clear();
  }
  Softened(const Softened&) = delete;
  Softened& operator=(const Softened&) = delete;

  /// The laws' memories as they were.
  void restore() {
    this->each([&](auto p, Index i) { whole_.template prepare<p>(i, whole_.template local<p>(i).W); });
  }
  bool is_out_of_time() { return whole_.is_out_of_time(); }
  void notify(int, const Measure&) const {}

 private:
  Problem& whole_;
};

}  // namespace delassus::inner
