/// Collision detection with libccd 2.1.
#pragma once

#include <delassus/adapters/ccd_kernel.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/native_engine.hpp>

namespace delassus {

/// Our trees of boxes, and libccd's penetrations, each certified; a refused one is computed by GjkEpa and
/// counted as a reject. Nothing is allocated in a warm step, by us or by libccd.
using CcdCollision = NativeDetection<CcdKernel, BoxTree>;
/// What its refusals begin with.
template <>
inline constexpr const char* name_of_backend<CcdKernel> = "CcdCollision";

}  // namespace delassus
