/// What a law writes its linearisation with.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/row_system.hpp>

#include <type_traits>

namespace delassus {

/// One end of a constraint: the blocks that move one material point, where the law enters its directions.
template <class World, class Pool>
class RowEnd {
 public:
  using T = typename Pool::Scalar;

  RowEnd(const World& world, Pool& pool, const Anchor& anchor, const Vec3& point)
      : world_(world), pool_(pool), anchor_(anchor), point_(point) {
    world_.visit(anchor_.set, [&](const auto& set, auto s) {
      auto& blocks = inner::part<s>(pool_.sets);
      first_ = Index(blocks.block.size());
      const int count = set.anchor_blocks(anchor_);
      for (int k = 0; k < count; ++k) {
        blocks.block.push_back(set.anchor_block(anchor_, k));
        blocks.H.push_back(zero<typename std::remove_cvref_t<decltype(blocks.H)>::value_type>());
      }
    });
  }

  /// Row k sees the velocity of the point along `direction`: u_k += direction · v(point).
  void along(int k, const Vec3& direction) {
    world_.visit(anchor_.set, [&](const auto& set, auto s) {
      auto& blocks = inner::part<s>(pool_.sets);
      const int count = set.anchor_blocks(anchor_);
      for (int b = 0; b < count; ++b)
        add_to_row(blocks.H[first_ + b], k, set.along(anchor_, b, point_, direction));
    });
  }

  /// The first n rows see the velocity of the point along the rows of `axes`, times `sign`: one visit for all of them.
  template <int n>
  void along(const Mat<n, 3>& axes, double sign) {
    world_.visit(anchor_.set, [&](const auto& set, auto s) {
      auto& blocks = inner::part<s>(pool_.sets);
      const int count = set.anchor_blocks(anchor_);
      for (int b = 0; b < count; ++b)
        for_each_index<n>([&](auto row) {
          constexpr int k = row;
          const Vec3 direction(sign * axes(k, 0), sign * axes(k, 1), sign * axes(k, 2));
          add_to_row(blocks.H[first_ + b], k, set.along(anchor_, b, point_, direction));
        });
    });
  }

  /// The first three rows see the velocity of the point along the axes of the world, times `sign`. With r from the centre
  /// of a body to the point, v + ω × r = [1, −skew(r)] (v, ω).
  void along_axes(double sign) {
    world_.visit(anchor_.set, [&](const auto& set, auto s) {
      using Set = std::remove_cvref_t<decltype(set)>;
      if constexpr (HasInverseInertia<Set> && Set::width == 6) {
        if (set.anchor_blocks(anchor_) == 0) return;
        auto& H = inner::part<s>(pool_.sets).H[first_];
        const Vec3 r = sign * (point_ - set.centre(anchor_.block));
        const Mat<3, 3, T> cross = skew(Vec<3, T>(r.template cast<T>()));
        for (int k = 0; k < 3; ++k) {
          H(k, k) += T(sign);
          for (int i = 0; i < 3; ++i) H(i, 3 + k) -= cross(i, k);
        }
      } else {
        for (int k = 0; k < 3; ++k) along(k, sign * unit_axis(k));
      }
    });
  }

  /// Row k sees the rate of turn about `axis`: u_k += axis · ω. The anchor must have a frame.
  void about(int k, const Vec3& axis) {
    world_.visit(anchor_.set, [&](const auto& set, auto s) {
      if constexpr (requires { set.about(anchor_, 0, axis); }) {
        auto& blocks = inner::part<s>(pool_.sets);
        const int count = set.anchor_blocks(anchor_);
        for (int b = 0; b < count; ++b)
          add_to_row(blocks.H[first_ + b], k, set.about(anchor_, b, axis));
      }
    });
  }

 private:
  template <int R, int width, class S>
  static void add_to_row(Mat<R, width, T>& H, int k, const Vec<width, S>& x) {
    for (int j = 0; j < width; ++j) H(k, j) += T(x[j]);
  }

  const World& world_;
  Pool& pool_;
  const Anchor& anchor_;
  Vec3 point_;
  Index first_ = 0;
};

/// Writes H and φ of one item. A law never divides by h: φ becomes a rate in step/bias.hpp.
template <class World, class Pool>
class RowWriter {
 public:
  RowWriter(const World& world, Pool& pool, Index item) : world_(world), pool_(pool), item_(item) {}

  /// The blocks that move the material point of `anchor` that is at `point` (world, m) now.
  RowEnd<World, Pool> end(const Anchor& anchor, const Vec3& point) { return {world_, pool_, anchor, point}; }

  /// Violation of row k, m or rad.
  void phi(int k, double value) { pool_.phi[item_][k] = typename Pool::Scalar(value); }

  /// Makes row k a spring with a damper, N/m and N·s/m (N·m/rad and N·m·s/rad for a row about an axis). A row of kind
  /// `friction` is one only if its law has speed(item).
  void soft(int k, double stiffness, double damping) {
    pool_.stiffness[item_][k] = typename Pool::Scalar(stiffness);
    pool_.damping[item_][k] = typename Pool::Scalar(damping);
  }

 private:
  const World& world_;
  Pool& pool_;
  Index item_;
};

}  // namespace delassus
