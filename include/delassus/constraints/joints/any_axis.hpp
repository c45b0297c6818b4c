/// Which coordinate a pair of ends has, said while the program runs.
#pragma once

#include <delassus/constraints/joints/coordinate.hpp>
#include <delassus/constraints/joints/euler_angles.hpp>

#include <utility>

namespace delassus {

/// The coordinates of pairs of ends, by name.
enum class AxisKind { turn, slide, precession, nutation, spin, length };

namespace inner {

inline bool is_axis_kind(AxisKind kind) { return kind >= AxisKind::turn && kind <= AxisKind::length; }

/// f.operator()<C>() with the coordinate C of that kind.
template <class F>
decltype(auto) with_axis(AxisKind kind, F&& f) {
  switch (kind) {
    case AxisKind::turn:
      break;
    case AxisKind::slide:
      return f.template operator()<Slide>();
    case AxisKind::precession:
      return f.template operator()<Precession>();
    case AxisKind::nutation:
      return f.template operator()<Nutation>();
    case AxisKind::spin:
      return f.template operator()<Spin>();
    case AxisKind::length:
      return f.template operator()<Length>();
  }
  return f.template operator()<Turn>();
}

/// That of the coordinate.
inline const char* name_of(AxisKind kind) {
  constexpr const char* names[]{"Turn", "Slide", "Precession", "Nutation", "Spin", "Length"};
  return names[int(kind)];
}
/// Its value in a pose near that in which it was `last`.
inline double axis_value(AxisKind kind, const JointFrames& frames, double last) {
  return with_axis(kind, [&]<class C>() { return unwound<C>(C::value(frames), last); });
}
inline void write_axis(AxisKind kind, auto& joint, int row, double factor) {
  with_axis(kind, [&]<class C>() { C::write(joint, row, factor); });
}

}  // namespace inner
}  // namespace delassus
