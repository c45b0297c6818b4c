/// The integer in which the library counts and stores positions in its arrays.
#pragma once

#include <cstdint>

namespace delassus {

using Index = std::int32_t;

}  // namespace delassus
