/// The version of the library.
#pragma once

namespace delassus {

struct Version {
  int major, minor, patch;
};
inline constexpr Version version{0, 1, 0};

}  // namespace delassus
