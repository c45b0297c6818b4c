/// The rows of a step as arrays of numbers that grow: what plain code reads and writes, whatever the laws and the bodies are.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/pool_rows.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/soft.hpp>

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace delassus {

template <class T>
struct SetArrays;

/// Products with the blocks of one pool and one set, whose sizes the functions know.
template <class T>
struct BlockProducts {
  /// u = start + H v of item i, v by block; `start` may be u.
  void (*rate)(const SetArrays<T>&, Index i, const T* v, const T* start, T* u);
  /// to += G λ of items i of 0 … items − 1, `to` by block.
  void (*add_motion)(const SetArrays<T>&, Index items, const T* lambda, T* to);
  /// to += Hᵀ λ, likewise.
  void (*add_impulse)(const SetArrays<T>&, Index items, const T* lambda, T* to);
};

/// `SetBlocks` without its sizes.
template <class T>
struct SetArrays {
  Array<Index> *offset, *block;
  Array<T> *H, *G;
  int width;
  const BlockProducts<T>* products;
};

namespace inner {

template <int R, int w, class T>
struct BlockLoops {
  using Row = Vec<R, T>;
  using Column = Vec<w, T>;

  /// `start` and `u` stand anywhere, whatever their alignment.
  static void rate(const SetArrays<T>& set, Index i, const T* v, const T* start, T* u) {
    const auto* H = reinterpret_cast<const Mat<R, w, T>*>(set.H->data());
    Row sum;
    std::memcpy(sum.data(), start, sizeof sum);
    for (Index e = (*set.offset)[i]; e < (*set.offset)[i + 1]; ++e)
      sum += H[e] * reinterpret_cast<const Column*>(v)[(*set.block)[e]];
    std::memcpy(u, sum.data(), sizeof sum);
  }
  static void add_motion(const SetArrays<T>& set, Index items, const T* lambda, T* to) {
    const auto* G = reinterpret_cast<const Mat<w, R, T>*>(set.G->data());
    for (Index i = 0; i < items; ++i)
      for (Index e = (*set.offset)[i]; e < (*set.offset)[i + 1]; ++e)
        reinterpret_cast<Column*>(to)[(*set.block)[e]] += G[e] * reinterpret_cast<const Row*>(lambda)[i];
  }
  static void add_impulse(const SetArrays<T>& set, Index items, const T* lambda, T* to) {
    const auto* H = reinterpret_cast<const Mat<R, w, T>*>(set.H->data());
    for (Index i = 0; i < items; ++i)
      for (Index e = (*set.offset)[i]; e < (*set.offset)[i + 1]; ++e)
        reinterpret_cast<Column*>(to)[(*set.block)[e]] += H[e].transpose() * reinterpret_cast<const Row*>(lambda)[i];
  }
  static const BlockProducts<T> table;
};

template <int R, int w, class T>
constinit const BlockProducts<T> BlockLoops<R, w, T>::table = {rate, add_motion, add_impulse};

}  // namespace inner

/// `PoolRows` without its sizes: item i has the numbers R i … R i + R − 1 of each array.
template <class T>
struct RowArrays {
  int rows, sets;
  const SetArrays<T>* set;
  Array<T> *phi, *stiffness, *damping, *bias, *compliance, *relative_compliance, *d, *lambda;

  Index items() const { return Index(phi->size()) / rows; }
  /// Row k of item i is a spring, or a damper.
  bool is_soft(std::size_t row) const { return inner::is_spring((*stiffness)[row], (*damping)[row]); }

  /// Room for the rows of `items` items, which are begun and closed one by one, in order.
  void reset(Index items) const {
    if (items == 0 && phi->empty()) return;  // a law without items, step after step
    for (int s = 0; s < sets; ++s) {
      set[s].offset->assign_zeros(1);
      set[s].block->clear();
      set[s].H->clear();
      set[s].G->clear();
    }
    for (auto* array : {phi, stiffness, damping, bias, compliance, relative_compliance, d, lambda})
      array->resize_for_overwrite(std::size_t(items) * std::size_t(rows));
  }
  /// The next item, i: its R rows are zero, and without entries.
  template <int R>
  void begin(Index i) const {
    for (auto* array : {phi, stiffness, damping, bias, compliance, relative_compliance, d, lambda})
      set_zero(reinterpret_cast<Vec<R, T>*>(array->data())[i]);
  }
  /// The entries of the next item end here in every set.
  void close() const {
    for (int s = 0; s < sets; ++s) set[s].offset->push_back(Index(set[s].block->size()));
  }
  /// Exchanges the rows of two pools of the same sizes.
  void swap(const RowArrays& other) const {
    for (int s = 0; s < sets; ++s) {
      const SetArrays<T>&mine = set[s], &its = other.set[s];
      mine.offset->swap(*its.offset), mine.block->swap(*its.block), mine.H->swap(*its.H), mine.G->swap(*its.G);
    }
    phi->swap(*other.phi), stiffness->swap(*other.stiffness), damping->swap(*other.damping), bias->swap(*other.bias);
    compliance->swap(*other.compliance), relative_compliance->swap(*other.relative_compliance), d->swap(*other.d), lambda->swap(*other.lambda);
  }
};

namespace inner {

/// u = H v of item i, `v` by set and block. There is a set.
template <class T>
void rate(const RowArrays<T>& pool, Index i, const T* const* v, T* u) {
  static constexpr T nothing[most_rows] = {};
  const T* before = nothing;
  for (int s = 0; s < pool.sets; ++s, before = u) pool.set[s].products->rate(pool.set[s], i, v[s], before, u);
}

}  // namespace inner

/// The arrays of rows, with room for what it says of them: `ArraysOf(rows).all()` of a RowSystem, or those
/// of one pool.
template <class Rows>
class ArraysOf;

template <int R, class T, int... w>
class ArraysOf<PoolRows<R, T, w...>> : public RowArrays<T> {
 public:
  explicit ArraysOf(PoolRows<R, T, w...>& pool) { fill(pool, *this, sets_); }
  ArraysOf(const ArraysOf&) = delete;

  [[gnu::always_inline]] static void fill(PoolRows<R, T, w...>& pool, RowArrays<T>& out, SetArrays<T>* set) {
    out = {R, int(sizeof...(w)), set, &pool.phi.numbers, &pool.stiffness.numbers, &pool.damping.numbers, &pool.bias.numbers,
           &pool.compliance.numbers, &pool.relative_compliance.numbers, &pool.d.numbers, &pool.lambda.numbers};
    pool.sets.each([&]<int width>(SetBlocks<R, width, T>& s) __attribute__((always_inline)) {
      *set++ = {&s.offset, &s.block, &s.H.numbers, &s.G.numbers, width, &inner::BlockLoops<R, width, T>::table};
    });
  }

 private:
  SetArrays<T> sets_[sizeof...(w) + 1];
};

template <class T, int... w, int... R>
class ArraysOf<RowSystem<T, Widths<w...>, R...>> {
 public:
  ArraysOf() = default;  ///< of nothing, before it is attached
  /// Const rows too: who only reads writes nothing.
  explicit ArraysOf(const RowSystem<T, Widths<w...>, R...>& rows) { attach(rows); }

  /// The rows may have moved with their loop.
  void attach(const RowSystem<T, Widths<w...>, R...>& rows) {
    if (of_ == &rows) return;
    of_ = &rows;
    int p = 0;
    const_cast<RowSystem<T, Widths<w...>, R...>&>(rows).pools.each([&]<class Pool>(Pool& pool) __attribute__((always_inline)) {
      ArraysOf<Pool>::fill(pool, pools_[p], sets_[p]);
      ++p;
    });
  }
  /// A copy is of nothing.
  ArraysOf(const ArraysOf&) {}
  ArraysOf& operator=(const ArraysOf&) {
    of_ = nullptr;
    return *this;
  }

  inner::Slice<const RowArrays<T>> all() const { return {pools_, sizeof...(R)}; }

 private:
  const void* of_ = nullptr;
  RowArrays<T> pools_[sizeof...(R) + 1];
  SetArrays<T> sets_[sizeof...(R) + 1][sizeof...(w) + 1];
};

template <class Rows>
ArraysOf(Rows&) -> ArraysOf<std::remove_const_t<Rows>>;

/// All rows of a step, by pool.
template <class T>
using AllRows = inner::Slice<const RowArrays<T>>;

}  // namespace delassus
