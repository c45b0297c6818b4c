/// A growing array of small matrices of one size, kept as numbers.
#pragma once

#include <delassus/core/array.hpp>

#include <cstddef>
#include <initializer_list>
#include <span>

namespace delassus {

/// What the type of a matrix says of its size: asked here, the matrix itself need not be read by the compiler.
template <class M>
struct SizeOfMatrix;
template <template <class, int, int, int...> class Matrix, class T, int R, int C, int... more>
struct SizeOfMatrix<Matrix<T, R, C, more...>> {
  using Scalar = T;
  static constexpr std::size_t count = std::size_t(R) * std::size_t(C);
};

/// What Array<M> is, for a matrix M of fixed size. Its numbers lie by columns in an `Array` of scalars, which plain code reads
/// without knowing M. All sizes of M share that type in a program.
template <class M>
class BlockArray {
  using T = typename SizeOfMatrix<M>::Scalar;
  static constexpr std::size_t size_of = SizeOfMatrix<M>::count;

 public:
  using value_type = M;

  [[gnu::always_inline]] BlockArray() {}
  BlockArray(std::initializer_list<M> list) { *this = list; }
  [[gnu::always_inline]] BlockArray(const BlockArray& other) : numbers(other.numbers) {}
  [[gnu::always_inline]] BlockArray(BlockArray&& other) noexcept : numbers(static_cast<Array<T>&&>(other.numbers)) {}
  [[gnu::always_inline]] BlockArray& operator=(const BlockArray& other) {
    numbers = other.numbers;
    return *this;
  }
  [[gnu::always_inline]] BlockArray& operator=(BlockArray&& other) noexcept {
    numbers = static_cast<Array<T>&&>(other.numbers);
    return *this;
  }
  /// The matrices of another list.
  template <class List>
    requires requires(const List& list) { list.begin(), list.end(); }
  BlockArray& operator=(const List& list) {
    numbers.clear();
    for (const M& x : list) push_back(x);
    return *this;
  }
  [[gnu::always_inline]] ~BlockArray() {}

  [[gnu::always_inline]] M* data() { return reinterpret_cast<M*>(numbers.data()); }
  [[gnu::always_inline]] const M* data() const { return reinterpret_cast<const M*>(numbers.data()); }
  [[gnu::always_inline]] std::size_t size() const { return numbers.size() / size_of; }
  [[gnu::always_inline]] std::size_t capacity() const { return numbers.capacity() / size_of; }
  [[gnu::always_inline]] bool empty() const { return numbers.empty(); }
  [[gnu::always_inline]] M* begin() { return data(); }
  [[gnu::always_inline]] M* end() { return data() + size(); }
  [[gnu::always_inline]] const M* begin() const { return data(); }
  [[gnu::always_inline]] const M* end() const { return data() + size(); }
  [[gnu::always_inline]] M& operator[](std::size_t i) { return data()[i]; }
  [[gnu::always_inline]] const M& operator[](std::size_t i) const { return data()[i]; }
  [[gnu::always_inline]] M& back() { return end()[-1]; }
  [[gnu::always_inline]] const M& back() const { return end()[-1]; }

  [[gnu::always_inline]] void reserve(std::size_t count) { numbers.reserve(count * size_of); }
  [[gnu::always_inline]] void clear() { numbers.clear(); }
  /// New matrices are zero.
  [[gnu::always_inline]] void resize(std::size_t count) { numbers.resize(count * size_of); }
  /// New matrices are whatever lies there.
  [[gnu::always_inline]] void resize_for_overwrite(std::size_t count) { numbers.resize_for_overwrite(count * size_of); }
  /// All are zero.
  [[gnu::always_inline]] void assign_zeros(std::size_t count) { numbers.assign_zeros(count * size_of); }
  void set_zero(std::size_t i) {
    for (std::size_t k = 0; k < size_of; ++k) numbers[i * size_of + k] = T(0);
  }
  [[gnu::always_inline]] void push_back(const M& x) { numbers.append(x.data(), size_of); }
  /// One more, of whatever lies there.
  [[gnu::always_inline]] M& emplace_back() {
    numbers.resize_for_overwrite(numbers.size() + size_of);
    return back();
  }
  [[gnu::always_inline]] void swap(BlockArray& other) noexcept { numbers.swap(other.numbers); }
  [[gnu::always_inline]] friend void swap(BlockArray& a, BlockArray& b) noexcept { a.swap(b); }
  [[gnu::always_inline]] friend bool operator==(const BlockArray& a, const BlockArray& b) { return a.numbers == b.numbers; }
  template <class List>
    requires requires(const List& list) { list.begin(), list.size(); }
  friend bool operator==(const BlockArray& a, const List& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < b.size(); ++i)
      if (!(a[i] == b[i])) return false;
    return true;
  }

  Array<T> numbers;
};

}  // namespace delassus
