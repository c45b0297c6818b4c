/// What the checks of a description share: who is meant, which numbers will do, which indices are of a list.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/model/model.hpp>

#include <cstddef>
#include <set>
#include <string>

namespace delassus::inner {

/// No length, mass or force of a machine is larger, in SI units: its fourth power is still finite.
inline constexpr double largest_in_model = 1e50;

inline bool is_sane(double x) { return std::abs(x) <= largest_in_model; }
template <int R, int C>
bool is_sane(const Mat<R, C>& x) {
  for (int k = 0; k < R * C; ++k)
    if (!is_sane(x.data()[k])) return false;
  return true;
}

/// One element of a list of the model, for sentences: "model 'arm': joint 3 'elbow'".
struct ModelElement {
  const Model& model;
  const char* kind;
  Index index;
  const std::string& name;

  std::string text() const {
    return "model '" + model.name + "': " + kind + " " + std::to_string(index) +
           (name.empty() ? "" : " '" + name + "'");
  }
  void expect(bool holds, const char* rule) const {
    if (!holds) refuse(text() + ": " + rule);
  }
  void expect_sane(double x, const char* what) const {
    if (!is_sane(x))
      refuse(text() + ": " + what + " is " + inner::text(x) + "; it must be finite, and 1e50 at most");
  }
  template <int R, int C>
  void expect_sane(const Mat<R, C>& x, const char* what) const {
    for (int k = 0; k < R * C; ++k) expect_sane(x.data()[k], what);
  }
  void expect_at_least_zero(double x, const char* what) const {
    expect_sane(x, what);
    if (x < 0) refuse(text() + ": " + what + " is " + inner::text(x) + " and must be >= 0");
  }
  void expect_positive(double x, const char* what) const {
    expect_sane(x, what);
    if (!(x > 0)) refuse(text() + ": " + what + " is " + inner::text(x) + " and must be > 0");
  }
  void expect_range(double lower, double upper, const char* what) const {
    expect_sane(lower, what);
    expect_sane(upper, what);
    if (lower > upper)
      refuse(text() + ": " + what + " go from " + inner::text(lower) + " to " + inner::text(upper) +
             "; the lower one must come first");
  }
  /// `least` is −1 where none, or the world, will do.
  void expect_index(Index i, std::size_t count, const char* what, Index least = 0) const {
    if (i < least || i >= Index(count))
      refuse(text() + ": " + what + " is " + std::to_string(i) + " and must be in [" + std::to_string(least) +
             ", " + std::to_string(count) + ")");
  }
  void expect_pose(const Pose& pose) const {
    expect_sane(pose.position, "a place");
    expect_sane(pose.rotation, "a rotation");
    const Mat3 product = transposed(pose.rotation) * pose.rotation;
    double off = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(product(i, j) - (i == j ? 1 : 0)));
    const Vec3 x(pose.rotation(0, 0), pose.rotation(1, 0), pose.rotation(2, 0)),
        y(pose.rotation(0, 1), pose.rotation(1, 1), pose.rotation(2, 1)),
        z(pose.rotation(0, 2), pose.rotation(1, 2), pose.rotation(2, 2));
    expect(off <= 1e-9 && dot(cross(x, y), z) > 0,
           "its rotation is no rotation matrix; the columns must be orthonormal and right-handed");
  }
};

/// Calls `visit(element, who)` for all of a list; two of them may not have one name, and no name is fine.
template <class T>
void check_each(const Model& model, const char* kind, const std::vector<T>& list, auto visit) {
  std::set<std::string> names;
  Index i = 0;
  for (const T& element : list) {
    static const std::string none;
    const std::string* name = &none;
    if constexpr (requires { element.name; }) name = &element.name;
    const ModelElement who{model, kind, i++, *name};
    who.expect(name->empty() || names.insert(*name).second,
               "another one has its name; give it one of its own");
    visit(element, who);
  }
}

}  // namespace delassus::inner
