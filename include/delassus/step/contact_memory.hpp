/// Impulses of contacts from one step to the next, found by name or by place.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/core/slice.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace delassus {

/// What is remembered of the contacts of the last step, sorted by pair and feature. A name is found by
/// bisection. A contact that has lost its name is looked for along the longest axis of its pair, whose order is
/// made when the first one asks. So n contacts of one pair, as two soft surfaces have, cost n log n.
template <class Scalar>
class BasicContactMemory {
 public:
  using Vec3 = Vec<3, Scalar>;
  struct Entry {
    std::uint64_t pair;
    std::uint32_t feature;
    bool is_taken;
    Vec3 point, impulse;
  };

  /// What makes one look after the other fast. It is of one memory, and of one thread.
  struct Search {
    Array<Index> order;                        ///< of one pair, by `axis`
    Index ordered_begin = 0, ordered_end = 0;  ///< that pair's entries
    int axis = 0;
    std::size_t next = 0;  ///< behind the entry that was found last by its name: all of that name before it are taken

    /// For a memory that is new, of at most so many entries.
    void begin(std::size_t entries) {
      order.reserve(entries);
      ordered_begin = ordered_end = 0;
      next = 0;
    }
    void clear() {}
  };

  /// Entries to be filled with the contacts of the step, then `sort`.
  inner::Slice<Entry> renew(std::size_t count) {
    entries_.resize(count);
    search_.order.reserve(entries_.capacity());  // now, with more contacts than ever, and not when one has lost its name
    return entries_;
  }
  std::size_t capacity() const { return entries_.capacity(); }
  /// Of who asks alone.
  Search& search() { return search_; }
  void sort() {
    search_.ordered_begin = search_.ordered_end = 0;
    search_.next = 0;
    const auto before = [](const Entry& x, const Entry& y) {
      return x.pair != y.pair ? x.pair < y.pair : x.feature < y.feature;
    };
    if (!inner::is_sorted(entries_.data(), entries_.data() + entries_.size(), before))
      inner::sort(entries_, before);
  }

  /// The impulse of the contact of this name, or the nearest unclaimed one of its pair within `reach()`, m,
  /// which is asked for there alone. Zero when there is none.
  template <class Reach>
  Vec3 take(std::uint64_t pair, std::uint32_t feature, const Vec3& point, const Reach& reach) {
    return take(pair, feature, point, reach, search_);
  }
  /// The same from several threads at once, each with a search of its own. All that ask for one pair are one thread.
  template <class Reach>
  Vec3 take(std::uint64_t pair, std::uint32_t feature, const Vec3& point, const Reach& reach, Search& by) {
    const auto is_before = [](const Entry& e, const std::pair<std::uint64_t, std::uint32_t>& name) {
      return e.pair != name.first ? e.pair < name.first : e.feature < name.second;
    };
    const auto has_name = [&](const Entry& e) { return e.pair == pair && e.feature == feature; };
    // Contacts ask in the order of their names, mostly.
    if (by.next < entries_.size() && has_name(entries_[by.next]) && !entries_[by.next].is_taken) return claim(entries_[by.next++]);
    for (auto e = inner::lower_bound(entries_.data(), entries_.data() + entries_.size(), std::pair(pair, feature), is_before);
         e != entries_.end() && has_name(*e); ++e)
      if (!e->is_taken) {
        by.next = std::size_t(e - entries_.begin()) + 1;
        return claim(*e);
      }
    Entry* const nearest = find_near(pair, point, reach(), by);
    return nearest ? claim(*nearest) : zero<Vec3>();
  }

  /// What is remembered of a pair, by feature.
  inner::Slice<const Entry> of_pair(std::uint64_t pair) const {
    const auto is_before = [](const Entry& e, std::uint64_t p) { return e.pair < p; };
    const Entry *const end = entries_.data() + entries_.size(),
                *const first = inner::lower_bound(entries_.data(), end, pair, is_before);
    const Entry* last = first;
    while (last != end && last->pair == pair) ++last;
    return {first, std::size_t(last - first)};
  }

  /// Of all pairs, sorted by pair and feature.
  inner::Slice<const Entry> entries() const { return entries_; }
  /// Whether a pair pushed.
  bool pushed(std::uint64_t pair) const {
    for (const Entry& e : of_pair(pair))
      if (!is_zero(e.impulse)) return true;
    return false;
  }

  void memory(auto& archive) {
    archive(entries_);
    search_.ordered_begin = search_.ordered_end = 0;
    search_.next = 0;
  }

 private:
  static Vec3 claim(Entry& e) {
    e.is_taken = true;
    return e.impulse;
  }

  /// Of what is equally near, the last by name.
  Entry* find_near(std::uint64_t pair, const Vec3& point, Scalar reach, Search& by) {
    order_pair(pair, by);
    const int axis = by.axis;
    const auto is_lower = [&](Index i, Scalar x) { return entries_[i].point[axis] < x; };
    Index found = -1;
    Scalar nearest = reach * reach;
    for (auto i = inner::lower_bound(by.order.data(), by.order.data() + by.order.size(), point[axis] - reach, is_lower);
         i != by.order.end() && entries_[*i].point[axis] <= point[axis] + reach; ++i) {
      if (entries_[*i].is_taken) continue;
      const Scalar distance = squared_norm(Vec3(entries_[*i].point - point));
      if (distance < nearest || (distance == nearest && *i > found)) nearest = distance, found = *i;
    }
    return found < 0 ? nullptr : &entries_[found];
  }

  /// Puts the entries of a pair in order along the axis of their longest extent.
  void order_pair(std::uint64_t pair, Search& by) {
    if (by.ordered_begin < by.ordered_end && entries_[by.ordered_begin].pair == pair) return;
    const auto is_before = [](const Entry& e, std::uint64_t p) { return e.pair < p; };
    by.ordered_begin =
        Index(inner::lower_bound(entries_.data(), entries_.data() + entries_.size(), pair, is_before) - entries_.begin());
    by.ordered_end = by.ordered_begin;
    by.order.clear();
    for (; by.ordered_end < Index(entries_.size()) && entries_[by.ordered_end].pair == pair; ++by.ordered_end)
      if (is_finite(entries_[by.ordered_end].point)) by.order.push_back(by.ordered_end);
    if (by.order.empty()) return;
    Vec3 low = entries_[by.order[0]].point, high = low;
    for (const Index i : by.order)
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], entries_[i].point[k]), high[k] = std::max(high[k], entries_[i].point[k]);
    by.axis = largest_entry(Vec3(high - low));
    inner::sort(by.order, [&](Index i, Index j) {
      const Scalar x = entries_[i].point[by.axis], y = entries_[j].point[by.axis];
      return x != y ? x < y : i < j;
    });
  }

  Array<Entry> entries_;
  Search search_;
};

using ContactMemory = BasicContactMemory<double>;

}  // namespace delassus
