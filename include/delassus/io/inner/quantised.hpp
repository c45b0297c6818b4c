/// Numbers in 16 bits: an interval divided evenly, and rotations by their three smallest components.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/io/inner/text.hpp>
#include <delassus/math/linear.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>

namespace delassus::inner {

/// The smallest interval that holds what was included, divided into 65535 equal parts.
///
///   |value(code(x)) − x| ≤ (high − low) / 131070   for low ≤ x ≤ high, up to rounding of doubles.
struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  /// nan and inf are left out.
  void include(double x) {
    if (!std::isfinite(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  bool is_empty() const { return !(low <= high); }

  /// Pre: x is a number. `parts` below 65535 leave the last words for other meanings.
  std::uint16_t code(double x, int parts = 65535) const {
    if (!(high > low)) return 0;
    return std::uint16_t(std::lround(std::clamp((x - low) / (high - low), 0.0, 1.0) * parts));
  }
  double value(std::uint16_t code) const { return low + (high - low) * (code / 65535.0); }
};

/// A unit quaternion in 48 bits: which component is the largest (2 bits), the other three in 15 bits each.
///
/// The largest is made positive and left out; the others lie in [−1/√2, 1/√2] and err by at most e =
/// √2/65534. The largest is at least 1/2 and the others together at most √3/2, so it errs by at most √3 · √3
/// e = 3e, the quaternion by √(3 + 9) e, and the rotation by twice that angle: 2 √12 e = 1.5e-4 rad.
using TurnCode = std::array<std::uint16_t, 3>;

inline TurnCode turn_code(const Quat& rotation) {
  const Vec<4> q = rotation.coeffs().normalized();  // (x, y, z, w)
  Index largest = 0;
  for (Index k = 1; k < 4; ++k)
    if (std::abs(q[k]) > std::abs(q[largest])) largest = k;
  const double sign = q[largest] < 0 ? -1 : 1;
  TurnCode words{};
  for (Index k = 0, i = 0; k < 4; ++k) {
    if (k == largest) continue;
    const double unit = std::clamp(0.5 + sign * q[k] / std::sqrt(2.0), 0.0, 1.0);
    words[i++] = std::uint16_t(std::lround(unit * 32767) << 1);
  }
  words[0] = std::uint16_t(words[0] | largest >> 1);
  words[1] = std::uint16_t(words[1] | (largest & 1));
  return words;
}

/// A list of 16-bit words, lowest byte first, that goes into the page as base64.
class Words {
 public:
  void push(std::uint16_t word) {
    bytes_ += char(word & 255);
    bytes_ += char(word >> 8);
  }
  void append_to(std::string& out) const {
    out += '"';
    append_base64(out, bytes_);
    out += '"';
  }

 private:
  std::string bytes_;
};

}  // namespace delassus::inner
