/// The local solve of a row whose force has a cap.
#pragma once

#include <delassus/constraints/refinements.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <algorithm>
#include <array>
#include <string>

namespace delassus {

/// λ = P(−b/W), P the projection on |λ| ≤ h F: u = 0 where the cap F (N or N·m) suffices, the whole cap
/// against u where not. Exact at every visit. F = ∞ is no cap. The items say `max_force`.
struct Bounded {
  static constexpr int rows = 1;
  static constexpr std::array<RowKind, 1> kinds{RowKind::friction};
  static constexpr auto refines = refine::prepare | refine::clamp | refine::tangent;

  /// Of one row, made by each `prepare`.
  template <class T>
  struct Memory {
    T most;  ///< h F, N·s or N·m·s
  };

  template <class Item, class T>
  void prepare(const Item& item, const Mat<1, 1, T>&, double h, Memory<T>& memory) const {
    memory.most = T(h * item.max_force);
  }
  template <class Item, class T>
  Vec<1, T> solve_local(const Item& item, const Mat<1, 1, T>& W, const Vec<1, T>& b, Memory<T>& memory) const {
    Vec<1, T> lambda(W(0, 0) > T(0) ? -b[0] / W(0, 0) : T(0));
    clamp(item, lambda, memory);
    return lambda;
  }
  template <class Item, class T>
  void clamp(const Item&, Vec<1, T>& lambda, const Memory<T>& memory) const {
    lambda[0] = std::clamp(lambda[0], -memory.most, memory.most);
  }
  /// −∂λ/∂d is 1/W below the cap, zero at it and where nothing moves. The memory's scalar need not be that of
  /// `c`.
  template <class Item, class T, class S>
  Mat<1, 1, T> tangent(const Item&, Local<1, T>& c, const Memory<S>& memory) const {
    if (!(c.W(0, 0) > T(0))) {
      c.lambda[0] = T(0);
      return Mat<1, 1, T>(T(0));
    }
    const T most = T(memory.most), free = c.lambda[0] - c.d[0] / c.W(0, 0);
    c.lambda[0] = std::clamp(free, -most, most);
    return Mat<1, 1, T>(c.lambda[0] == free ? 1 / c.W(0, 0) : T(0));
  }

  /// Throws where max_force is negative or not a number; `what` and `unit` are for the sentence.
  static void check_cap(double max_force, const char* what, const char* unit) {
    DELASSUS_EXPECT(max_force >= 0,
                    std::string(what) + ": max_force " + inner::text(max_force) + " must be >= 0 " + unit);
  }
};

}  // namespace delassus
