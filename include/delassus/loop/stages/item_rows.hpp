/// The rows of one constraint with two ends, written out: they stay in registers.
#pragma once

#include <delassus/core/unrolled.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/anchor.hpp>

#include <array>
#include <type_traits>

namespace delassus {

/// One row of H, or of Gᵀ, over the velocities of one block.
template <int width, class T>
struct RowOfBlock;

template <class T>
struct RowOfBlock<3, T> {
  Vec<3, T> linear;

  RowOfBlock() {}
  explicit RowOfBlock(const Vec<3, T>& row) : linear(row) {}
  Vec<3, T> whole() const { return linear; }
  T dot(const RowOfBlock& o) const {
    return linear[0] * o.linear[0] + linear[1] * o.linear[1] + linear[2] * o.linear[2];
  }
  void operator+=(const RowOfBlock& o) { linear += o.linear; }
};

template <class T>
struct RowOfBlock<6, T> {
  Vec<3, T> linear, angular;

  RowOfBlock() {}
  explicit RowOfBlock(const Vec<6, T>& row) : linear(linear_part(row)), angular(angular_part(row)) {}
  Vec<6, T> whole() const { return twist<T>(linear, angular); }
  T dot(const RowOfBlock& o) const {
    return linear[0] * o.linear[0] + linear[1] * o.linear[1] + linear[2] * o.linear[2] +
           angular[0] * o.angular[0] + angular[1] * o.angular[1] + angular[2] * o.angular[2];
  }
  void operator+=(const RowOfBlock& o) { linear += o.linear, angular += o.angular; }
};

/// H and Gᵀ = H A⁻¹ of one end, row by row.
template <int R, int width, class T>
struct RowsOfEnd {
  static constexpr bool answers = true;
  std::array<RowOfBlock<width, T>, R> H, G;

  /// −0 + x is x for every x, so that the first addition to a row costs nothing.
  void clear() {
    unrolled<R>([this]<int k>() { H[k] = RowOfBlock<width, T>(Vec<width, T>::Constant(T(-0.0))); });
  }
};

/// Of an end in the world, or on a body that never moves.
struct NoRows {
  static constexpr bool answers = false;
  void clear() {}
};

/// All rows of one item: what `PoolRows` is for the items of a law.
template <int R, class T, class RowsOfA, class RowsOfB>
struct ItemRows {
  using Scalar = T;
  RowsOfA a;
  RowsOfB b;
  std::array<T, R> phi, stiffness, damping;

  void clear() {
    a.clear(), b.clear();
    unrolled<R>([this]<int k>() { phi[k] = stiffness[k] = damping[k] = T(0); });
  }
};

/// What `RowEnd` is to a law, for one of the two ends: the sets of both, −1 for none, are known where this is
/// compiled.
template <class World, class Rows, int set_of_a, int set_of_b>
class ItemEnd {
 public:
  ItemEnd(const World& world, Rows& rows, const Anchor& anchor, const Vec3& point, bool is_a)
      : world_(world), rows_(rows), anchor_(anchor), point_(point), is_a_(is_a) {}

  void along(int k, const Vec3& direction) {
    add(k, [&](const auto& set) { return set.along(anchor_, 0, point_, direction); });
  }
  template <int n>
  void along(const Mat<n, 3>& axes, double sign) {
    unrolled<n>([&]<int k>() { along(k, Vec3(sign * axes(k, 0), sign * axes(k, 1), sign * axes(k, 2))); });
  }
  void about(int k, const Vec3& axis) {
    add(k, [&](const auto& set) {
      using Set = std::remove_cvref_t<decltype(set)>;
      if constexpr (requires { set.about(anchor_, 0, axis); })
        return set.about(anchor_, 0, axis);
      else
        return Vec<Set::width, typename Rows::Scalar>::Zero().eval();
    });
  }

 private:
  template <class F>
  void add(int k, const F& row) {
    if (is_a_)
      add_to<set_of_a>(rows_.a, k, row);
    else
      add_to<set_of_b>(rows_.b, k, row);
  }
  template <int s, class End, class F>
  void add_to(End& end, int k, const F& row) {
    if constexpr (End::answers) {
      using Row = std::remove_reference_t<decltype(end.H[k])>;
      end.H[k] += Row(row(world_.template set<s>()));
    }
  }

  const World& world_;
  Rows& rows_;
  const Anchor& anchor_;
  Vec3 point_;
  bool is_a_;
};

/// What `RowWriter` is to a law.
template <class World, class Rows, int set_of_a, int set_of_b>
class ItemWriter {
 public:
  ItemWriter(const World& world, Rows& rows, const Anchor& a, const Anchor& b)
      : world_(world), rows_(rows), a_(a), b_(b) {}

  ItemEnd<World, Rows, set_of_a, set_of_b> end(const Anchor& anchor, const Vec3& point) {
    return {world_, rows_, anchor, point, is_a(anchor)};
  }
  void phi(int k, double value) { rows_.phi[k] = typename Rows::Scalar(value); }
  void soft(int k, double stiffness, double damping) {
    rows_.stiffness[k] = typename Rows::Scalar(stiffness);
    rows_.damping[k] = typename Rows::Scalar(damping);
  }

 private:
  /// By its address, which is known where this is compiled; a law may copy its anchors too.
  bool is_a(const Anchor& anchor) const {
    return &anchor == &a_ || (&anchor != &b_ && anchor.set == a_.set && anchor.block == a_.block);
  }

  const World& world_;
  Rows& rows_;
  const Anchor &a_, &b_;
};

}  // namespace delassus
