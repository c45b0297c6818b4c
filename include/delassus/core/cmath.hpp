/// `<cmath>`, read once.
///
/// The standard library's header has no guard that lets a compiler skip it. So g++ reads its two thousand lines again at each
/// inclusion. It forgets where expressions begin and end in short once it has read a few hundred thousand lines.
#pragma once

#include <cmath>
