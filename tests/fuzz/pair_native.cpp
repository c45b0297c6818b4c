// Contacts of any shapes in any poses by the native kernel.
#include "pair.hpp"

#include <delassus/collision/gjk_epa.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::collide<delassus::GjkEpa>(data, size);
}
