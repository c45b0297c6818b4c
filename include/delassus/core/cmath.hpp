/// `<cmath>`, read once.
///
/// The standard library's header has no guard that lets a compiler skip it. So g++ reads its two thousand lines again at each
/// inclusion. It forgets where expressions begin and end in short once it has read a few hundred thousand lines.
#pragma once

// Under these nothing is found to be no number: a body whose force is one would spoil all others.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "delassus: -ffast-math, -Ofast and -ffinite-math-only hide numbers that are not finite from the library; take -O3, with -fno-math-errno and -ffp-contract=fast as you like"
#endif

#include <cmath>
