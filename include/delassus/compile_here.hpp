/// Compiles what `delassus/compiled.hpp` leaves out: for one file of a program.
#pragma once

#include <delassus/compiled.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

namespace delassus {

template <int alignment>
const int inner::CompiledWithAlignment<alignment>::bytes = alignment;
template struct inner::CompiledWithAlignment<EIGEN_MAX_STATIC_ALIGN_BYTES>;

#define DELASSUS_COMPILED_IS_SOUND(KIND, ...) \
  static_assert(inner::law_is_sound<__VA_ARGS__, WorldView<double>>() && inner::law_linearizes<__VA_ARGS__, double>());
DELASSUS_COMPILED_CONTACTS(DELASSUS_COMPILED_IS_SOUND, )
DELASSUS_COMPILED_JOINTS(DELASSUS_COMPILED_IS_SOUND, )

DELASSUS_COMPILED_PARTS(template)
DELASSUS_COMPILED_DIRECT(template, 3)
DELASSUS_COMPILED_DIRECT(template, 5)
DELASSUS_COMPILED_DIRECT(template, 6)

}  // namespace delassus

DELASSUS_COMPILED_VECTORS(template)
