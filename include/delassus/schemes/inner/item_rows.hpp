/// The rows of one constraint with two ends, written out beside each other: what a visit needs of the waist.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/writer.hpp>

#include <array>
#include <type_traits>

namespace delassus {

/// f(s), s an integral constant: the set of an end, −1 for the world and for a body that never moves.
template <int s = 0, class World, class F>
void with_set(const World& world, const Anchor& end, F&& f) {
  if constexpr (s == World::set_count) {
    f(std::integral_constant<int, -1>{});
  } else {
    if (end.set == s && world.template set<s>().anchor_blocks(end) > 0) f(std::integral_constant<int, s>{});
    else with_set<s + 1>(world, end, f);
  }
}

/// f(s) for an end on a body that may move.
template <class World, class F>
void with_set_of_body(const World& world, const Anchor& end, F&& f) {
  with_set(world, end, [&]<int s>(std::integral_constant<int, s> set) {
    if constexpr (s >= 0) f(set);
  });
}

/// H of one end, row by row; the last three columns of a block that does not turn are zero.
template <int R>
using RowsOfEnd = std::array<Vec<6>, std::size_t(R)>;

/// All rows of one item in double: what `PoolRows` is for the items of a law.
template <int R>
struct ItemRows {
  RowsOfEnd<R> a, b;
  Vec<R> phi, stiffness, damping;

  ItemRows() {
    for (int k = 0; k < R; ++k) set_zero(a[std::size_t(k)]), set_zero(b[std::size_t(k)]);
    set_zero(phi), set_zero(stiffness), set_zero(damping);
  }
};

/// What `RowEnd` is to a law, for one of the two ends.
template <class World, int R>
class ItemEnd {
 public:
  ItemEnd(const World& world, RowsOfEnd<R>& rows, const Anchor& anchor, const Vec3& point)
      : world_(world), rows_(rows), anchor_(anchor), point_(point) {}

  void along(int k, const Vec3& direction) {
    add(k, [&](const auto& set) { return set.along(anchor_, 0, point_, direction); });
  }
  template <int n>
  void along(const Mat<n, 3>& axes, double sign) {
    for (int k = 0; k < n; ++k) along(k, Vec3(sign * axes.row(k).transpose()));
  }
  void along_axes(double sign) {
    for (int k = 0; k < 3; ++k) along(k, sign * unit_axis(k));
  }
  /// Nothing for an end that does not turn.
  void about(int k, const Vec3& axis) {
    add(k, [&](const auto& set) {
      using Set = std::remove_cvref_t<decltype(set)>;
      if constexpr (requires { set.about(anchor_, 0, axis); }) return set.about(anchor_, 0, axis);
      else return zero<Mat<Set::width, 1, typename Set::Scalar>>().eval();
    });
  }

 private:
  template <class F>
  void add(int k, const F& row) {
    inner::expect_row(k, R);
    with_set_of_body(world_, anchor_, [&](auto s) {
      const auto& set = world_.template set<s>();
      rows_[std::size_t(k)].template head<std::remove_cvref_t<decltype(set)>::width>() += row(set).template cast<double>();
    });
  }

  const World& world_;
  RowsOfEnd<R>& rows_;
  const Anchor& anchor_;
  Vec3 point_;
};

/// What `RowWriter` is to a law.
template <class World, int R>
class ItemWriter {
 public:
  ItemWriter(const World& world, ItemRows<R>& rows, const Anchor& a, const Anchor& b)
      : world_(world), rows_(rows), a_(a), b_(b) {}

  ItemEnd<World, R> end(const Anchor& anchor, const Vec3& point) {
    return {world_, is_a(anchor) ? rows_.a : rows_.b, anchor, point};
  }
  void phi(int k, double value) {
    inner::expect_row(k, R);
    rows_.phi[k] = value;
  }
  void soft(int k, double stiffness, double damping) {
    inner::expect_row(k, R);
    rows_.stiffness[k] = stiffness, rows_.damping[k] = damping;
  }

 private:
  /// By its address, or, where a law copies its anchors, by its body: the two ends are never on one.
  bool is_a(const Anchor& anchor) const {
    return &anchor == &a_ || (&anchor != &b_ && anchor.set == a_.set && anchor.block == a_.block);
  }

  const World& world_;
  ItemRows<R>& rows_;
  const Anchor &a_, &b_;
};

}  // namespace delassus
