/// The rows of all constraints as flat arrays: how many an item has is a number, and so is where they begin.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>

namespace light {

using namespace delassus;

/// One block of bodies that an item acts on, through H (R × width) and, where A is block-diagonal there, G =
/// A⁻¹ Hᵀ (width × R), both by columns from `place` on.
struct Entry {
  Index block;     ///< in the world's count
  Index velocity;  ///< of the block, in the world's count
  Index place;
  int set, width;
};

/// Items are counted through the pools. Item i has rows row[i] … row[i + 1] − 1 and entries entry[i] …
/// entry[i + 1] − 1. Units as in `PoolRows`.
template <class T>
struct Rows {
  Array<Index> row{0}, entry{0};
  Array<Entry> entries;
  Array<T> H, G;
  Array<T> phi, stiffness, damping, bias, compliance, relative_compliance, d, lambda;  ///< one number a row

  Index items() const { return Index(row.size()) - 1; }
  Index count() const { return row.back(); }
  int rows_of(Index item) const { return int(row[item + 1] - row[item]); }

  void reset() {
    row.assign(1, 0);
    entry.assign(1, 0);
    entries.clear();
    H.clear();
    each_number([](Array<T>& x) { x.clear(); });
  }
  /// One item more, of `rows` zero rows and without entries; `close` ends it.
  void open(int rows) {
    row.push_back(row.back() + rows);
    each_number([&](Array<T>& x) { x.resize(std::size_t(row.back()), T(0)); });
  }
  void close() { entry.push_back(Index(entries.size())); }

 private:
  template <class F>
  void each_number(const F& f) {
    for (auto* x : {&phi, &stiffness, &damping, &bias, &compliance, &relative_compliance, &d, &lambda}) f(*x);
  }
};

}  // namespace light
