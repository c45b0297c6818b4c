/// Small matrices that lie one after the other in an array of numbers.
#pragma once

#include <delassus/core/array.hpp>

#include <cstddef>
#include <type_traits>

namespace delassus {

/// The numbers of `Numbers`, an Array of scalars, as matrices M by columns. It refers to the array, which owns them.
template <class M, class Numbers>
class BlockList {
  static constexpr std::size_t size_of = std::size_t(M::RowsAtCompileTime) * std::size_t(M::ColsAtCompileTime);
  using Block = std::conditional_t<std::is_const_v<Numbers>, const M, M>;

 public:
  using value_type = M;

  explicit BlockList(Numbers& numbers) : numbers_(&numbers) {}

  Block* begin() const { return reinterpret_cast<Block*>(numbers_->data()); }
  Block* end() const { return begin() + size(); }
  Block* data() const { return begin(); }
  Block& operator[](std::size_t k) const { return begin()[k]; }
  Block& back() const { return end()[-1]; }
  std::size_t size() const { return numbers_->size() / size_of; }
  std::size_t capacity() const { return numbers_->capacity() / size_of; }
  void reserve(std::size_t count) const { numbers_->reserve(count * size_of); }
  bool empty() const { return numbers_->empty(); }
  /// New matrices are zero.
  void resize(std::size_t count) const { numbers_->resize(count * size_of); }
  friend bool operator==(const BlockList& a, const BlockList& b) { return *a.numbers_ == *b.numbers_; }
  void push_back(const M& block) const {
    const std::size_t last = size();
    resize(last + 1);
    begin()[last] = block;
  }

 private:
  Numbers* numbers_;
};

}  // namespace delassus
