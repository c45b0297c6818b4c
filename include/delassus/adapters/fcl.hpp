/// Collision detection with FCL, the Flexible Collision Library 0.7.
#pragma once

#include <delassus/adapters/fcl_kernel.hpp>
#include <delassus/adapters/fcl_tree.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/native_engine.hpp>

namespace delassus {

/// FCL's tree and FCL's distances, each answer certified; a refused one is computed by GjkEpa and counted as
/// a reject. A warm step allocates nothing of ours; FCL itself allocates in `collide` (its list of contact
/// points).
using FclCollision = NativeDetection<FclKernel, FclTree>;
/// What its refusals begin with.
template <>
inline constexpr const char* name_of_backend<FclKernel> = "FclCollision";

}  // namespace delassus
