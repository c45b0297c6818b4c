/// The version of the library.
#pragma once

namespace delassus {

/// A release of the library.
struct Version {
  /// @var major
  /// The first number.
  /// @var minor
  /// The second one.
  int major, minor, patch;  ///< the third one
};
inline constexpr Version version{0, 1, 0};  ///< of these headers

}  // namespace delassus
