/// Two numbers side by side, of which g++ and clang++ make one register.
#pragma once

#include <cstring>

namespace delassus::inner {

/// Arithmetic and `a < b ? a : b` act on each lane; loops of scalars over least values they leave scalar.
typedef double TwoLanes __attribute__((vector_size(16)));

inline TwoLanes two_lanes_at(const double* x) {
  TwoLanes out;
  std::memcpy(&out, x, sizeof out);
  return out;
}
/// In one store: two would keep a load of both waiting.
inline void put_two_lanes(TwoLanes x, double* to) { std::memcpy(to, &x, sizeof x); }
inline TwoLanes two_lanes_at(const float* x) { return TwoLanes{double(x[0]), double(x[1])}; }

}  // namespace delassus::inner
