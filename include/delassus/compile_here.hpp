/// Compiles what `delassus/compiled.hpp` leaves out: for one file of a program.
#pragma once

#include <delassus/compiled.hpp>

namespace delassus {

template <int alignment>
const int inner::CompiledWithAlignment<alignment>::bytes = alignment;
template struct inner::CompiledWithAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>;

DELASSUS_COMPILED_PARTS(template)

}  // namespace delassus
