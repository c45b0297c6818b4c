/// Sorting, selecting and searching of lists that lie in one piece, in few functions.
#pragma once

#include <cstddef>
#include <utility>

namespace delassus::inner {

// What std::sort and its like are, for pointers and for lists that have data() and size(). A debug build makes some
// sixty functions of std::sort for each element type and order, and one of this one. Equal elements may change places.

/// a < b, by the type's own operator; of pairs without what std makes of a three-way comparison.
struct Smaller {
  template <class A, class B>
  [[gnu::always_inline]] bool operator()(const std::pair<A, B>& a, const std::pair<A, B>& b) const {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  }
  template <class A, class B>
  [[gnu::always_inline]] bool operator()(const A& a, const B& b) const {
    return a < b;
  }
};

/// x goes where it belongs in the heap [0, count) below `hole`, whose element is free; the largest is on top.
template <class T, class Less>
[[gnu::always_inline]] inline void sift_down(T* heap, std::size_t count, std::size_t hole, T& x, const Less& less) {
  for (std::size_t child = 2 * hole + 1; child < count; child = 2 * hole + 1) {
    if (child + 1 < count && less(heap[child], heap[child + 1])) ++child;
    if (!less(x, heap[child])) break;
    heap[hole] = static_cast<T&&>(heap[child]);
    hole = child;
  }
  heap[hole] = static_cast<T&&>(x);
}
/// The last of [0, count) goes where it belongs in the heap of the others.
template <class T, class Less = Smaller>
[[gnu::always_inline]] inline void push_on_heap(T* heap, std::size_t count, const Less& less = {}) {
  std::size_t hole = count - 1;
  T x = static_cast<T&&>(heap[hole]);
  for (; hole > 0 && less(heap[(hole - 1) / 2], x); hole = (hole - 1) / 2) heap[hole] = static_cast<T&&>(heap[(hole - 1) / 2]);
  heap[hole] = static_cast<T&&>(x);
}
/// The largest of [0, count) goes behind the heap of the others.
template <class T, class Less = Smaller>
[[gnu::always_inline]] inline void pop_from_heap(T* heap, std::size_t count, const Less& less = {}) {
  T x = static_cast<T&&>(heap[count - 1]);
  heap[count - 1] = static_cast<T&&>(heap[0]);
  if (count > 1) sift_down(heap, count - 1, 0, x, less);
}

/// Moves what is no larger than some element of [first, last) to the front, what is no smaller behind it, and returns
/// where the second begins: neither part is empty. Pre: three elements at the least.
template <class T, class Less>
[[gnu::always_inline]] inline T* partition(T* first, T* last, const Less& less) {
  T *const middle = first + (last - first) / 2, *const end = last - 1;
  // The median of three.
  const T* median = less(*first, *middle) ? (less(*middle, *end) ? middle : less(*first, *end) ? end : first)
                                          : (less(*first, *end) ? first : less(*middle, *end) ? end : middle);
  const T pivot = *median;
  T *low = first, *high = end;
  for (;;) {
    while (less(*low, pivot)) ++low;
    while (less(pivot, *high)) --high;
    if (low >= high) break;
    T x = static_cast<T&&>(*low);
    *low = static_cast<T&&>(*high);
    *high = static_cast<T&&>(x);
    ++low, --high;
  }
  return low == first ? first + 1 : low;
}

/// Sorts [first, last) ascending: by partition, and small parts by insertion. Where partition went wrong `tries` times, by
/// insertion over gaps of … 40, 13, 4 and 1, which takes n^(3/2) at the most.
template <class T, class Less>
void sort_part(T* first, T* last, int tries, const Less& less) {
  while (last - first > 16 && tries-- > 0) {
    T* const middle = inner::partition(first, last, less);
    if (middle - first < last - middle) {
      sort_part(first, middle, tries, less);
      first = middle;
    } else {
      sort_part(middle, last, tries, less);
      last = middle;
    }
  }
  if (last - first < 2) return;
  std::ptrdiff_t gap = 1;
  while (gap < (last - first) / 9) gap = 3 * gap + 1;
  for (; gap > 0; gap /= 3)
    for (T* next = first + gap; next < last; ++next) {
      if (!less(*next, next[-gap])) continue;
      T x = static_cast<T&&>(*next);
      T* hole = next;
      do {
        *hole = static_cast<T&&>(hole[-gap]);
        hole -= gap;
      } while (hole - first >= gap && less(x, hole[-gap]));
      *hole = static_cast<T&&>(x);
    }
}

/// Twice the logarithm of a count: how often its partition may go wrong.
[[gnu::always_inline]] inline int tries_of(std::ptrdiff_t count) {
  int tries = 0;
  for (; count > 1; count /= 2) tries += 2;
  return tries;
}

/// Sorts ascending; not stable.
template <class T, class Less = Smaller>
[[gnu::always_inline]] inline void sort(T* first, T* last, const Less& less = {}) {
  sort_part(first, last, tries_of(last - first), less);
}
template <class List, class Less = Smaller>
  requires requires(List& list) { list.data(); }
[[gnu::always_inline]] inline void sort(List& list, const Less& less = {}) {
  inner::sort(list.data(), list.data() + list.size(), less);
}

/// Puts at `nth` what would stand there if [first, last) were sorted: what is before it is no larger, what is behind it no
/// smaller.
template <class T, class Less = Smaller>
void select(T* first, T* nth, T* last, const Less& less = {}) {
  int tries = tries_of(last - first);
  while (last - first > 16 && tries-- > 0) {
    T* const middle = inner::partition(first, last, less);
    if (nth < middle) last = middle;
    else first = middle;
  }
  inner::sort(first, last, less);
}

/// The first element of an ascending list that is not less than `key`, or the end. less(element, key).
template <class T, class Key, class Less = Smaller>
[[gnu::always_inline]] inline T* lower_bound(T* first, T* last, const Key& key, const Less& less = {}) {
  std::size_t count = std::size_t(last - first);
  while (count > 0) {
    const std::size_t half = count / 2;
    if (less(first[half], key)) first += half + 1, count -= half + 1;
    else count = half;
  }
  return first;
}
/// Whether an ascending list has an element equal to `key`.
template <class List, class Key>
[[gnu::always_inline]] inline bool is_listed(const List& list, const Key& key) {
  const auto* const end = list.data() + list.size();
  const auto* const at = inner::lower_bound(list.data(), end, key);
  return at != end && !(key < *at);
}

template <class T, class Less = Smaller>
[[gnu::always_inline]] inline bool is_sorted(const T* first, const T* last, const Less& less = {}) {
  bool is_so = true;
  if (first == last) return is_so;
  for (const T* next = first + 1; next < last && is_so; ++next) is_so = !less(*next, next[-1]);
  return is_so;
}

/// Sorts a list whose first `count` elements and the others mostly are in order, each part for itself. `scratch` is of the same
/// type.
template <class List, class Less = Smaller>
void sort_and_merge(List& list, std::size_t count, List& scratch, const Less& less = {}) {
  auto *const first = list.data(), *const middle = first + count, *const last = first + list.size();
  if (!inner::is_sorted(first, middle, less)) inner::sort(first, middle, less);
  if (!inner::is_sorted(middle, last, less)) inner::sort(middle, last, less);
  if (first == middle || middle == last || !less(*middle, middle[-1])) return;
  scratch.clear();
  scratch.reserve(list.capacity());
  auto *a = first, *b = middle;
  while (a != middle || b != last) {
    const bool is_b = a == middle || (b != last && less(*b, *a));
    scratch.push_back(is_b ? *b++ : *a++);
  }
  list.swap(scratch);
}

/// Of equal neighbours the first stays; returns the new end.
template <class T>
[[gnu::always_inline]] inline T* drop_repeats(T* first, T* last) {
  T* end = first;
  for (T* next = first; next != last; ++next)
    if (end == first || !(*next == end[-1])) {
      if (end != next) *end = static_cast<T&&>(*next);
      ++end;
    }
  return end;
}

template <class List>
  requires requires(List& list) { list.data(); }
[[gnu::always_inline]] inline void drop_repeats(List& list) {
  list.resize(std::size_t(inner::drop_repeats(list.data(), list.data() + list.size()) - list.data()));
}

}  // namespace delassus::inner
