// Contacts of any shapes in any poses by libccd.
#include "pair.hpp"

#include <delassus/adapters/ccd_kernel.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::collide<delassus::CcdKernel>(data, size);
}
