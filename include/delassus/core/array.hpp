/// A growing array for flat data: numbers, fixed-size matrices and plain structs of them.
#pragma once

#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

namespace delassus {
namespace inner {

/// Memory that is grown and copied without knowing the type in it: compiled once for all arrays.
struct ArrayMemory {
  void* data = nullptr;
  std::size_t size = 0, capacity = 0;  ///< in elements

  static void* allocate(std::size_t bytes, std::size_t alignment) {
    if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__) return ::operator new(bytes);
    return ::operator new(bytes, std::align_val_t(alignment));
  }
  void release(std::size_t alignment) {
    if (alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__)
      ::operator delete(data);
    else
      ::operator delete(data, std::align_val_t(alignment));
  }
  /// Room for `count` elements; what is there keeps its bytes.
  void reserve(std::size_t count, std::size_t width, std::size_t alignment) {
    if (count <= capacity) return;
    if (count > std::size_t(-1) / 2 / width) throw std::bad_array_new_length();
    void* const larger = allocate(count * width, alignment);
    if (size > 0) std::memcpy(larger, data, size * width);
    release(alignment);
    data = larger;
    capacity = count;
  }
  /// Room for `count` elements, twice of what there was at the least.
  void grow(std::size_t count, std::size_t width, std::size_t alignment) {
    if (count > capacity) reserve(count > 2 * capacity ? count : 2 * capacity, width, alignment);
  }
  /// One more element, a copy of x, where there is no room for it. x may be one of ours.
  [[gnu::noinline]] void* push(const void* x, std::size_t width, std::size_t alignment) {
    const std::size_t room = size > 0 ? 2 * size : 1;
    char* const larger = static_cast<char*>(allocate(room * width, alignment));
    if (size > 0) std::memcpy(larger, data, size * width);
    std::memcpy(larger + size * width, x, width);
    release(alignment);
    *this = {larger, size + 1, room};
    return larger + (size - 1) * width;
  }
  /// The bytes of another array in the place of these.
  void copy(const ArrayMemory& other, std::size_t width, std::size_t alignment) {
    if (this == &other) return;
    size = 0;
    reserve(other.size, width, alignment);
    if (other.size > 0) std::memcpy(data, other.data, other.size * width);
    size = other.size;
  }
  /// The other's memory in the place of this, and none for the other.
  void take(ArrayMemory& other, std::size_t alignment) noexcept {
    const ArrayMemory theirs = other;
    other = {};
    release(alignment);
    *this = theirs;
  }
  void swap(ArrayMemory& other) noexcept {
    const ArrayMemory mine = *this;
    *this = other;
    other = mine;
  }
};

// By the compiler's own word: std::is_trivially_destructible costs it a dozen templates for each type.
#if defined(__has_builtin) && __has_builtin(__is_trivially_destructible)
template <class T>
inline constexpr bool has_no_destructor = __is_trivially_destructible(T);
#else
template <class T>
inline constexpr bool has_no_destructor = __has_trivial_destructor(T);
#endif

/// Whether copying its bytes copies a T: it has no destructor, or one that does nothing, and then says
/// `using CopiedByBytes = T`.
template <class T>
inline constexpr bool is_copied_by_bytes = has_no_destructor<T>;
template <class T>
requires requires { typename T::CopiedByBytes; }
inline constexpr bool is_copied_by_bytes<T> = has_no_destructor<T> || std::is_same_v<T, typename T::CopiedByBytes>;

}  // namespace inner

/// What std::vector<T> is, for a T that copying its bytes copies: it is refused where T has a destructor. A
/// compiler makes some five functions of it for each T where it makes forty-five of a std::vector: members of one
/// line are inlined even where nothing else is. References end with growth, as there.
template <class T>
class Array {
  /// Numbers lie as vector instructions want small matrices of them.
  static constexpr std::size_t alignment =
      std::is_arithmetic_v<T> && alignof(T) < __BIGGEST_ALIGNMENT__ ? __BIGGEST_ALIGNMENT__ : alignof(T);

 public:
  using value_type = T;
  using size_type = std::size_t;
  using iterator = T*;
  using const_iterator = const T*;

  [[gnu::always_inline]] Array() : memory_{nullptr, 0, 0} {}
  explicit Array(std::size_t count) : Array() { resize(count); }
  Array(std::size_t count, const T& x) : Array() { resize(count, x); }
  Array(std::initializer_list<T> list) : Array() { assign(list.begin(), list.end()); }
  template <class It>
  requires(!std::is_arithmetic_v<It>) Array(It first, It last) : Array() { assign(first, last); }
  [[gnu::always_inline]] Array(const Array& other) : Array() { memory_.copy(other.memory_, sizeof(T), alignment); }
  [[gnu::always_inline]] Array(Array&& other) noexcept : Array() { memory_.swap(other.memory_); }
  [[gnu::always_inline]] Array& operator=(const Array& other) {
    memory_.copy(other.memory_, sizeof(T), alignment);
    return *this;
  }
  [[gnu::always_inline]] Array& operator=(Array&& other) noexcept {
    memory_.take(other.memory_, alignment);
    return *this;
  }
  // A list of another type is a template's argument: for a std::span compilers would look, at each assignment of an array, through
  // all that may become one.
  /// The elements of another list, which are none of this array's.
  template <class List>
    requires requires(const List& list) { list.begin(), list.end(); }
  Array& operator=(const List& list) {
    assign(list.begin(), list.end());
    return *this;
  }
  [[gnu::always_inline]] ~Array() {
    static_assert(inner::is_copied_by_bytes<T>,
                  "delassus: Array holds types without a destructor; take ArrayOrVector or std::vector");
    memory_.release(alignment);
  }

  [[gnu::always_inline]] T* data() { return static_cast<T*>(memory_.data); }
  [[gnu::always_inline]] const T* data() const { return static_cast<const T*>(memory_.data); }
  [[gnu::always_inline]] std::size_t size() const { return memory_.size; }
  [[gnu::always_inline]] std::size_t capacity() const { return memory_.capacity; }
  [[gnu::always_inline]] bool empty() const { return memory_.size == 0; }
  [[gnu::always_inline]] T* begin() { return static_cast<T*>(memory_.data); }
  [[gnu::always_inline]] T* end() { return static_cast<T*>(memory_.data) + memory_.size; }
  [[gnu::always_inline]] const T* begin() const { return static_cast<const T*>(memory_.data); }
  [[gnu::always_inline]] const T* end() const { return static_cast<const T*>(memory_.data) + memory_.size; }
  [[gnu::always_inline]] T& operator[](std::size_t i) { return static_cast<T*>(memory_.data)[i]; }
  [[gnu::always_inline]] const T& operator[](std::size_t i) const { return static_cast<const T*>(memory_.data)[i]; }
  [[gnu::always_inline]] T& front() { return *begin(); }
  [[gnu::always_inline]] const T& front() const { return *begin(); }
  [[gnu::always_inline]] T& back() { return end()[-1]; }
  [[gnu::always_inline]] const T& back() const { return end()[-1]; }

  [[gnu::always_inline]] void reserve(std::size_t count) { memory_.reserve(count, sizeof(T), alignment); }
  [[gnu::always_inline]] void clear() { memory_.size = 0; }
  /// New elements are T().
  void resize(std::size_t count) {
    if (count > memory_.capacity) memory_.grow(count, sizeof(T), alignment);
    for (std::size_t i = memory_.size; i < count; ++i) ::new (static_cast<void*>(begin() + i)) T();
    memory_.size = count;
  }
  /// New elements are whatever lies there, for who writes all of them.
  [[gnu::always_inline]] void resize_for_overwrite(std::size_t count) {
    static_assert(std::is_arithmetic_v<T>);
    if (count > memory_.capacity) memory_.grow(count, sizeof(T), alignment);
    memory_.size = count;
  }
  void resize(std::size_t count, const T& x) {
    const T copy = x;  // it may be one of ours
    if (count > memory_.capacity) memory_.grow(count, sizeof(T), alignment);
    for (std::size_t i = memory_.size; i < count; ++i) ::new (static_cast<void*>(begin() + i)) T(copy);
    memory_.size = count;
  }
  /// So many zeros.
  [[gnu::always_inline]] void assign_zeros(std::size_t count) {
    resize_for_overwrite(count);
    T* const x = begin();
    for (std::size_t i = 0; i < count; ++i) x[i] = T(0);
  }
  void assign(std::size_t count, const T& x) {
    const T copy = x;
    memory_.size = 0;
    resize(count, copy);
  }
  /// The elements of [first, last), which are none of this array's.
  template <class It>
  requires(!std::is_arithmetic_v<It>) void assign(It first, It last) {
    memory_.size = 0;
    append(first, last);
  }
  /// [first, last) behind what is there; they are none of this array's.
  template <class It>
  void append(It first, It last) {
    for (; first != last; ++first) push_back(*first);
  }
  /// So many elements from `first` on behind what is there; they are none of this array's.
  [[gnu::always_inline]] void append(const T* first, std::size_t count) {
    if (memory_.size + count > memory_.capacity) memory_.grow(memory_.size + count, sizeof(T), alignment);
    if (count > 0) std::memcpy(static_cast<void*>(end()), static_cast<const void*>(first), count * sizeof(T));
    memory_.size += count;
  }
  [[gnu::always_inline]] T& push_back(const T& x) {
    if (memory_.size == memory_.capacity) return *static_cast<T*>(memory_.push(&x, sizeof(T), alignment));
    return *::new (static_cast<T*>(memory_.data) + memory_.size++) T(x);
  }
  template <class... From>
  [[gnu::always_inline]] T& emplace_back(From&&... from) {
    if constexpr (!std::is_constructible_v<T, From...>) return push_back(T{static_cast<From&&>(from)...});
    else if (memory_.size == memory_.capacity) return push_back(T(static_cast<From&&>(from)...));
    else return *::new (static_cast<T*>(memory_.data) + memory_.size++) T(static_cast<From&&>(from)...);
  }
  [[gnu::always_inline]] void pop_back() { --memory_.size; }
  /// Takes the elements [first, last) out; those behind them move up.
  T* erase(T* first, T* last) {
    if (first == last) return first;
    std::memmove(static_cast<void*>(first), static_cast<const void*>(last),
                 std::size_t(end() - last) * sizeof(T));
    memory_.size -= std::size_t(last - first);
    return first;
  }
  [[gnu::always_inline]] T* erase(T* at) { return erase(at, at + 1); }
  /// Puts x before `at`.
  T* insert(T* at, const T& x) {
    const std::size_t place = std::size_t(at - begin());
    const T copy = x;
    memory_.grow(memory_.size + 1, sizeof(T), alignment);
    T* const here = begin() + place;
    std::memmove(static_cast<void*>(here + 1), static_cast<const void*>(here),
                 (memory_.size - place) * sizeof(T));
    ++memory_.size;
    return ::new (static_cast<void*>(here)) T(copy);
  }
  void shrink_to_fit() {
    Array tight(*this);
    memory_.swap(tight.memory_);
  }
  [[gnu::always_inline]] void swap(Array& other) noexcept { memory_.swap(other.memory_); }
  [[gnu::always_inline]] friend void swap(Array& a, Array& b) noexcept { a.memory_.swap(b.memory_); }
  [[gnu::always_inline]] friend bool operator==(const Array& a, const Array& b) { return a.equals(b); }
  template <class List>
    requires requires(const List& list) { list.begin(), list.size(); }
  friend bool operator==(const Array& a, const List& b) {
    return a.equals(b);
  }
  bool equals(const auto& b) const {
    const Array& a = *this;
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(a[i] == b[i])) return false;
    return true;
  }

 private:
  inner::ArrayMemory memory_;
};

/// For types that a user brings: Array where copying bytes copies them, std::vector where they own something.
template <class T>
using ArrayOrVector = std::conditional_t<inner::is_copied_by_bytes<T>, Array<T>, std::vector<T>>;

/// Takes out what `is_out` holds of; the rest keeps its order.
template <class T, class Is>
void erase_if(Array<T>& list, const Is& is_out) {
  std::size_t kept = 0;
  for (const T& x : list)
    if (!is_out(x)) list[kept++] = x;
  list.resize(kept);
}

}  // namespace delassus
