/// What plain code asks of a body set: one constant table of functions for each type of set.
#pragma once

#include <delassus/rows/body_set.hpp>

#include <span>

namespace light {

using namespace delassus;

/// Every function takes the set first. Velocities are `width` numbers a block, and lie one block after the
/// other.
template <class T>
struct SetTable {
  int width;
  Index (*blocks)(const void*);
  bool (*moves)(const void*, Index b);
  bool (*is_coupled)(const void*);  ///< A has entries between blocks
  void (*ties)(const void*, void* to, void (*tie)(void* to, Index a, Index b));
  void (*solve_block)(const void*, Index b, int columns, T* x);  ///< x ← A_b⁻¹ x, of each column
  void (*solve)(const void*, T* x);                              ///< x ← A⁻¹ x, of all blocks
  int (*anchor_blocks)(const void*, const Anchor&);
  Index (*anchor_block)(const void*, const Anchor&, int k);
  /// Unit forces at a point, one a row, or a unit moment, as rows of H of the anchor's block k: added to H,
  /// which lies by columns of R.
  void (*along)(const void*, const Anchor&, int k, const Vec3& point, const Vec3* directions, int count,
                int R, T* H);
  void (*about)(const void*, const Anchor&, int k, const Vec3& axis, int R, T* H);
  Vec3 (*point)(const void*, const Anchor&);
  Quat (*frame)(const void*, const Anchor&);
};

/// The functions of one type of set.
template <class Set>
struct FunctionsOf {
  using T = typename Set::Scalar;
  using V = Vec<Set::width, T>;
  static constexpr int width = Set::width;

  static const Set& of(const void* set) { return *static_cast<const Set*>(set); }
  static Index blocks(const void* set) { return of(set).blocks(); }
  static bool moves(const void* set, Index b) { return of(set).moves(b); }
  static bool is_coupled(const void* set) {
    if constexpr (requires { of(set).is_coupled(); }) return of(set).is_coupled();
    return false;
  }
  static void ties(const void* set, void* to, void (*tie)(void*, Index, Index)) {
    if constexpr (requires { of(set).each_tie([](Index, Index) {}); })
      of(set).each_tie([&](Index a, Index b) { tie(to, a, b); });
  }
  static void solve_block(const void* set, Index b, int columns, T* x) {
    for (int k = 0; k < columns; ++k, x += width) {
      Eigen::Map<V> here(x);
      const V right = here;
      here = of(set).template solve_block<1>(b, right);
    }
  }
  static void solve(const void* set, T* x) {
    if constexpr (requires(std::span<V> v) { of(set).solve(v); })
      of(set).solve(std::span<V>(reinterpret_cast<V*>(x), std::size_t(blocks(set))));
    else
      for (Index b = 0; b < blocks(set); ++b) solve_block(set, b, 1, x + std::size_t(width) * b);
  }
  static int anchor_blocks(const void* set, const Anchor& a) { return of(set).anchor_blocks(a); }
  static Index anchor_block(const void* set, const Anchor& a, int k) { return of(set).anchor_block(a, k); }
  static void along(const void* set, const Anchor& a, int k, const Vec3& point, const Vec3* directions,
                    int count, int R, T* H) {
    for (int n = 0; n < count; ++n) {
      const V h = of(set).along(a, k, point, directions[n]);
      for (int j = 0; j < width; ++j) H[n + R * j] += h[j];
    }
  }
  static void about(const void* set, const Anchor& a, int k, const Vec3& axis, int R, T* H) {
    if constexpr (FramedSet<Set>) {
      const V h = of(set).about(a, k, axis);
      for (int j = 0; j < width; ++j) H[R * j] += h[j];
    }
  }
  static Vec3 point(const void* set, const Anchor& a) { return of(set).point(a); }
  static Quat frame(const void* set, const Anchor& a) {
    if constexpr (FramedSet<Set>) return of(set).frame(a);
    return a.frame;
  }

  static constexpr SetTable<T> table{width,        &blocks, &moves,         &is_coupled,   &ties,
                                     &solve_block, &solve,  &anchor_blocks, &anchor_block, &along,
                                     &about,       &point,  &frame};
};

}  // namespace light
