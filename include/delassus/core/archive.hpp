/// What outlives a step, as bytes: each owner names it in `memory(archive)`.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/pack.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

namespace delassus {
namespace inner {

/// An archive says so by `static constexpr bool leaves_shapes = true;`: it takes what a step changes, and no shape and no mesh.
template <class Archive>
inline constexpr bool leaves_shapes = requires { requires Archive::leaves_shapes; };

/// Calls one(x) for the parts of x that can be copied byte by byte, and size(container) before the elements of a container.
/// An owner with memory(archive) is asked; what holds a pointer and has no memory(archive) must not be named.
void walk(auto& archive, auto& x) {
  if constexpr (requires { x.memory(archive); }) x.memory(archive);
  else archive.bytes(&x, sizeof x);
}
/// Of a list that can grow.
template <class Archive, class List>
  requires requires(List& list) { list.push_back(list[0]); }
void walk(Archive& archive, List& list) {
  archive.size(list);
  if constexpr (requires { list[0].memory(archive); } || !requires { list.data(); })
    for (auto& element : list) walk(archive, element);
  else archive.bytes(list.data(), list.size() * sizeof(list[0]));
}
template <class Archive, class E, std::size_t n>
void walk(Archive& archive, std::array<E, n>& list) {
  for (E& e : list) walk(archive, e);
}
template <class Archive, class E, std::size_t n>
void walk(Archive& archive, FixedArray<E, n>& list) {
  for (E& e : list) walk(archive, e);
}
template <class Archive, class... E>
void walk(Archive& archive, std::tuple<E...>& parts) {
  std::apply([&](E&... part) { (walk(archive, part), ...); }, parts);
}
template <class Archive, class Places, class... T>
void walk(Archive& archive, PackOf<Places, T...>& parts) {
  parts.each([&](auto& part) { walk(archive, part); });
}

}  // namespace inner

/// archive(a, b, …) appends their bytes.
class ArchiveWriter {
 public:
  static constexpr bool reads = false;
  std::vector<char> data;

  template <class... X>
  void operator()(X&... x) {
    (inner::walk(*this, x), ...);
  }
  void bytes(const void* from, std::size_t count) {
    const char* first = static_cast<const char*>(from);
    data.insert(data.end(), first, first + count);
  }
  void size(const auto& list) {
    const std::uint64_t count = list.size();
    bytes(&count, sizeof count);
  }
};

/// archive(a, b, …) gives them the bytes that a writer took, in the same order. Throws InvalidArgument where they end early.
class ArchiveReader {
 public:
  static constexpr bool reads = true;
  explicit ArchiveReader(std::span<const char> data) : left_(data) {}

  template <class... X>
  void operator()(X&... x) {
    (inner::walk(*this, x), ...);
  }
  void bytes(void* to, std::size_t count) {
    DELASSUS_EXPECT(count <= left_.size(), "checkpoint: it ends in the middle; it was not written whole");
    if (count > 0) std::memcpy(to, left_.data(), count);
    left_ = left_.subspan(count);
  }
  void size(auto& list) {
    std::uint64_t count = 0;
    bytes(&count, sizeof count);
    // Every element takes a byte at least: a count beyond that is damage, and must not become an allocation.
    DELASSUS_EXPECT(count <= left_.size(), "checkpoint: it ends in the middle; it was not written whole");
    list.resize(std::size_t(count));
  }
  bool is_at_end() const { return left_.empty(); }

 private:
  std::span<const char> left_;
};

}  // namespace delassus
