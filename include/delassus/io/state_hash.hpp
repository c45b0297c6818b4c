/// A number for the bits of a loop's state: two runs are equal where their numbers are.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/rows/alive.hpp>

#include <cstddef>
#include <cstdint>

namespace delassus {
namespace inner {

/// FNV-1a. Source: [FowlerNollVo].
struct Fingerprint {
  std::uint64_t value = 14695981039346656037ull;
  void bytes(const void* from, std::size_t count) {
    const auto* p = static_cast<const unsigned char*>(from);
    for (std::size_t i = 0; i < count; ++i) value = (value ^ p[i]) * 1099511628211ull;
  }
};

}  // namespace inner

/// A number for the bits of all velocities and places and of the joints' impulses: equal states, equal numbers.
template <class Loop>
std::uint64_t state_hash(const Loop& loop) {
  inner::Fingerprint print;
  loop.world().each([&](const auto& set, auto) {
    for (const Index b : alive(set)) {
      const auto pose = set.pose(b);
      const auto& v = set.velocity()[b];
      print.bytes(pose.position.data(), sizeof(double) * 3);
      print.bytes(pose.rotation.data(), sizeof(double) * 9);
      print.bytes(v.data(), sizeof(v[0]) * std::size_t(v.size()));
    }
  });
  loop.each_impulse([&](const auto& impulse) { print.bytes(impulse.data(), sizeof(double) * std::size_t(impulse.size())); });
  return print.value;
}

}  // namespace delassus
