/// A growing list of elements that own something: lists of lists, hulls.
#pragma once

#include <delassus/core/array.hpp>

#include <cstddef>

namespace delassus {

/// Each element stands by itself and never moves. What is taken out, by `clear` or a smaller `resize`, stays made and is
/// used again. So a list of lists that is filled anew each step allocates nothing once it is warm. An element comes
/// back empty, by its `clear()` where it has one and as T() where not.
template <class T>
class OwningArray {
  template <class E>
  struct Iterator {
    T* const* at;
    [[gnu::always_inline]] E& operator*() const { return **at; }
    [[gnu::always_inline]] Iterator& operator++() {
      ++at;
      return *this;
    }
    [[gnu::always_inline]] bool operator!=(const Iterator& o) const { return at != o.at; }
  };

 public:
  using value_type = T;

  [[gnu::always_inline]] OwningArray() {}
  [[gnu::always_inline]] explicit OwningArray(std::size_t count) { resize(count); }
  [[gnu::always_inline]] OwningArray(const OwningArray& other) { copy(other); }
  [[gnu::always_inline]] OwningArray(OwningArray&& other) noexcept { swap(other); }
  [[gnu::always_inline]] OwningArray& operator=(const OwningArray& other) {
    copy(other);
    return *this;
  }
  [[gnu::always_inline]] OwningArray& operator=(OwningArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~OwningArray() {
    for (T* const one : made_) delete one;
  }

  [[gnu::always_inline]] std::size_t size() const { return size_; }
  [[gnu::always_inline]] bool empty() const { return size_ == 0; }
  [[gnu::always_inline]] T& operator[](std::size_t i) { return *made_[i]; }
  [[gnu::always_inline]] const T& operator[](std::size_t i) const { return *made_[i]; }
  [[gnu::always_inline]] T& back() { return *made_[size_ - 1]; }
  [[gnu::always_inline]] const T& back() const { return *made_[size_ - 1]; }
  [[gnu::always_inline]] Iterator<T> begin() { return {made_.begin()}; }
  [[gnu::always_inline]] Iterator<T> end() { return {made_.begin() + size_}; }
  [[gnu::always_inline]] Iterator<const T> begin() const { return {made_.begin()}; }
  [[gnu::always_inline]] Iterator<const T> end() const { return {made_.begin() + size_}; }

  [[gnu::always_inline]] void clear() { size_ = 0; }
  void resize(std::size_t count) {
    for (; size_ < count; ++size_) {
      if (size_ == made_.size()) made_.push_back(new T());
      else if constexpr (requires(T& x) { x.clear(); }) made_[size_]->clear();
      else *made_[size_] = T();
    }
    size_ = count;
  }
  [[gnu::always_inline]] T& emplace_back() {
    resize(size_ + 1);
    return back();
  }
  [[gnu::always_inline]] void push_back(const T& x) { emplace_back() = x; }
  [[gnu::always_inline]] void swap(OwningArray& other) noexcept {
    made_.swap(other.made_);
    const std::size_t size = size_;
    size_ = other.size_;
    other.size_ = size;
  }

 private:
  void copy(const OwningArray& other) {
    if (this == &other) return;
    size_ = 0;
    for (const T& one : other) {
      if (size_ == made_.size()) made_.push_back(new T(one));
      else *made_[size_] = one;
      ++size_;
    }
  }

  Array<T*> made_;
  std::size_t size_ = 0;
};

}  // namespace delassus
