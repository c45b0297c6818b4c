/// Some elements of a list that lie one behind the other, wherever they are kept.
#pragma once

#include <cstddef>

namespace delassus::inner {

/// What std::span is, for functions of the library among themselves: a debug build makes some twenty functions of a span for
/// each type, and none of a slice. What users call takes std::span, which converts to it.
template <class T>
class Slice {
 public:
  [[gnu::always_inline]] Slice() : data_(nullptr), size_(0) {}
  [[gnu::always_inline]] Slice(T* data, std::size_t size) : data_(data), size_(size) {}
  template <class List>
    requires requires(List& list, T*& to) { to = list.data(); }
  [[gnu::always_inline]] Slice(List&& list) : data_(list.data()), size_(list.size()) {}

  [[gnu::always_inline]] T* data() const { return data_; }
  [[gnu::always_inline]] std::size_t size() const { return size_; }
  [[gnu::always_inline]] bool empty() const { return size_ == 0; }
  [[gnu::always_inline]] T& operator[](std::size_t i) const { return data_[i]; }
  [[gnu::always_inline]] T* begin() const { return data_; }
  [[gnu::always_inline]] T* end() const { return data_ + size_; }

 private:
  T* data_;
  std::size_t size_;
};

}  // namespace delassus::inner
