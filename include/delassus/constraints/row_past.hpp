/// What is remembered of rows that may bounce, from one step to the next.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/rows/row_kind.hpp>

#include <cstddef>
#include <cstdint>

namespace delassus {

/// Names an item of a pool from step to step: a contact by its pair and feature, a joint by its place. Bodies and joints that take
/// the place of removed ones have other generations.
struct ItemName {
  std::uint64_t item = 0, generations = 0;
  std::uint32_t feature = 0;
};

/// A row in the last step, in m/s or rad/s and positive where it opens.
struct RowPast {
  std::uint64_t item, generations;
  std::uint32_t feature, row;  ///< k of pool p: `most_rows` p + k
  double acceleration;  ///< m/s² or rad/s², without its own impulse
  double parts;           ///< > 0: it landed if it pushed, and parts with this speed; see `Rebound`
  double impulse;         ///< |λ|, N·s
};

/// The rows of the last step by name, and those of this one. Rows that ask in the order of the last step cost nothing to find.
class RowPasts {
 public:
  /// The rows of a step of h seconds are made; anew, where it is solved again.
  void begin(double h) {
    if (!(last_h_ > 0)) last_h_ = h;
    if (!(earlier_h_ > 0)) earlier_h_ = h;
    h_ = h;
    now_.clear();
    now_.reserve(before_.capacity());
    next_ = 0;
  }
  /// The step is over: what was added is the past.
  void end() {
    const auto is_before = [](const RowPast& x, const RowPast& y) { return Name(x) < Name(y); };
    if (!inner::is_sorted(now_.data(), now_.data() + now_.size(), is_before)) inner::sort(now_, is_before);
    before_.swap(now_);
    now_.clear();
    earlier_h_ = last_h_, last_h_ = h_;
  }
  bool empty() const { return before_.empty(); }  ///< no row was there
  double last_h() const { return last_h_; }  ///< of the step of the past, s
  double earlier_h() const { return earlier_h_; }  ///< of the step before that one
  /// Null: the row was not there.
  const RowPast* find(const ItemName& name, std::uint32_t row) {
    const RowPast *const first = before_.data(), *const last = first + before_.size();
    const Name asked{name.item, name.generations, name.feature, row};
    const RowPast* at = first + next_;
    if (!(at != last && Name(*at) == asked))
      at = inner::lower_bound(first, last, asked, [](const RowPast& x, const Name& y) { return Name(x) < y; });
    if (!(at != last && Name(*at) == asked)) return nullptr;
    next_ = std::size_t(at - first) + 1;
    return at;
  }
  RowPast& add(const ItemName& name, std::uint32_t row) {
    now_.push_back({name.item, name.generations, name.feature, row, 0, 0, 0});
    return now_.back();
  }
  /// The rows of this step, in the order in which they were added.
  Array<RowPast>& now() { return now_; }

  void memory(auto& archive) { archive(before_, last_h_, earlier_h_); }

 private:
  struct Name {
    std::uint64_t item, generations;
    std::uint32_t feature, row;
    Name(std::uint64_t i, std::uint64_t g, std::uint32_t f, std::uint32_t r) : item(i), generations(g), feature(f), row(r) {}
    explicit Name(const RowPast& r) : Name(r.item, r.generations, r.feature, r.row) {}
    bool operator==(const Name&) const = default;
    bool operator<(const Name& o) const {
      const auto pool = row / most_rows, other = o.row / most_rows;  // as the rows come, mostly
      if (pool != other) return pool < other;
      if (item != o.item) return item < o.item;
      if (feature != o.feature) return feature < o.feature;
      return row != o.row ? row < o.row : generations < o.generations;
    }
  };

  Array<RowPast> before_, now_;
  double h_ = 0, last_h_ = 0, earlier_h_ = 0;
  std::size_t next_ = 0;  ///< behind the one that was found last
};

}  // namespace delassus
