/// The laws of the position problem, which know bounds and nothing of friction.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/law_set.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

namespace delassus::inner {

/// Equalities stay equalities, bounds stay bounds, friction rows are locked at zero. All laws with these rows share it.
template <int R, std::array<RowKind, std::size_t(R)> of_rows>
struct PositionLaw {
  static constexpr int rows = R;
  static constexpr auto kinds = of_rows;
  static constexpr bool is_contact = true;  // it has no items that a host adds
  static constexpr unsigned refines = refine::natural_map | refine::tangent | refine::clamp;
  struct Item {};

  /// One projected Gauss-Seidel pass over the rows of a block, from the λ that they have; b is their velocity without it.
  template <class T>
  void relax(const Mat<rows, rows, T>& W, const Vec<rows, T>& b, Vec<rows, T>& lambda) const {
    Vec<rows, T> u = b + W * lambda;
    for (int k = 0; k < rows; ++k) {
      const T before = lambda[k];
      lambda[k] = bound(k, before - u[k] / W(k, k));
      for (int j = 0; j < rows; ++j) u[j] += W(j, k) * (lambda[k] - before);
    }
  }
  template <class T>
  Vec<rows, T> natural_map(const Item&, const Vec<rows, T>& lambda, const Vec<rows, T>& u, T scale) const {
    Vec<rows, T> out;
    for (int k = 0; k < rows; ++k) out[k] = scale * lambda[k] - bound(k, scale * lambda[k] - u[k]);
    return out;
  }
  /// Row by row: the slope of a bound is 1/W_kk where it lets through, 0 where it holds.
  template <class T>
  Mat<rows, rows, T> tangent(const Item&, Local<rows, T>& c) const {
    auto slope = zero<Mat<rows, rows, T>>();
    for (int k = 0; k < rows; ++k) {
      const T free = c.lambda[k] - c.d[k] / c.W(k, k);
      c.lambda[k] = bound(k, free);
      if (c.lambda[k] == free) slope(k, k) = T(1) / c.W(k, k);
    }
    return slope;
  }
  template <class T>
  void clamp(const Item&, Vec<rows, T>& lambda) const {
    for (int k = 0; k < rows; ++k) lambda[k] = bound(k, lambda[k]);
  }

 private:
  template <class T>
  static T bound(int k, T x) {
    switch (kinds[std::size_t(k)]) {
      case RowKind::equality: return x;
      case RowKind::lower: return std::max(T(0), x);
      case RowKind::upper: return std::min(T(0), x);
      case RowKind::friction: return T(0);
    }
    return x;
  }
};

template <class Constraints, class T, Needs needs>
class PositionLaws;

/// Shows each pool with the position problem of its law.
template <class... Laws, class T, Needs needs>
class PositionLaws<Constraints<Laws...>, T, needs> {
  static constexpr int pools = int(sizeof...(Laws));
  template <class Law>
  using ForLaw = PositionLaw<Law::rows, row_kinds<Law>()>;
  template <int p>
  using Law = ForLaw<std::tuple_element_t<p, std::tuple<Laws...>>>;

 public:
  template <class Operator, class Rows>
  void show(Operator& W, Rows& rows) {
    sets_.resize(std::size_t(pools * Rows::set_count));
    for_each_index<pools>([&](auto p) {
      auto* sets = sets_.data() + p * Rows::set_count;
      show_rows(rows.template pool<p>(), p, views_[p], sets);
      show_law<Law<p>, needs>(law_of<p>(), nothing_, nullptr, nothing_, views_[p]);
      show_W<p>(W, rows, views_[p], sets, &blocks_[p * pools], own_diagonals_[p]);
    });
  }
  const PoolView<T>& view(int pool) const { return views_[pool]; }

 private:
  template <int p>
  static const Law<p>& law_of() {
    static constexpr Law<p> law{};
    return law;
  }

  PoolView<T> views_[pools > 0 ? pools : 1];
  BlockRowsView<T> blocks_[pools > 0 ? pools * pools : 1];
  Array<SetBlocksView<T>> sets_;
  Array<T> own_diagonals_[pools > 0 ? pools : 1];
  char nothing_[1] = {};
};

}  // namespace delassus::inner
