// Contacts of any shapes in any poses by FCL.
#include "pair.hpp"

#include <delassus/adapters/fcl_kernel.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::collide<delassus::FclKernel>(data, size);
}
