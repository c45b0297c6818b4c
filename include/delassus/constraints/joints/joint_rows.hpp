/// The equations that joints are made of: points that coincide along an axis, axes that stay perpendicular.
#pragma once

#include <delassus/core/expect.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/anchor.hpp>

#include <string>
#include <utility>

namespace delassus {
namespace inner {

/// a · b, summed from the last product on.
template <class T>
inline T dot_from_end(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
  return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
}

}  // namespace inner

/// Where the two ends of a joint are in the world: points (m) and axes, the columns a_k and b_k.
struct JointFrames {
  Vec3 xa, xb;
  Mat3 A, B;

  JointFrames(const Anchor& a, const Anchor& b, const auto& world)
      : xa(world.point(a)),
        xb(world.point(b)),
        A(world.axes(a)),
        B(world.axes(b)) {}

  Vec3 a(int k) const { return column(A, k); }
  Vec3 b(int k) const { return column(B, k); }
};

/// Writes the rows of a joint between the ends a and b. Both act at x_b, so that the impulses of a row are opposite and
/// have one line: They keep momentum and angular momentum exactly, whatever is left of the violation. A row's positive
/// impulse pushes a along, or turns a about, an axis of a's frame. With x = x_a − x_b and ω = ω_a − ω_b:
///
///   (a_i · x)˙   = a_i · (v_a − v_b) at x_b,
///   (a_i · b_j)˙ = (a_i × b_j) · ω.
///
/// Both hold in every pose, closed or not, and are at most quadratic in the rotations. An implicit midpoint rule that
/// takes them at the mean of the axes therefore keeps them.
template <class World, class Row>
class JointRows : public JointFrames {
  using End = decltype(std::declval<Row&>().end(std::declval<const Anchor&>(), std::declval<const Vec3&>()));

 public:
  JointRows(const Anchor& a, const Anchor& b, const World& world, Row& row)
      : JointFrames(a, b, world), row_(row), a_(row.end(a, xb)), b_(row.end(b, xb)) {}

  /// Row k: φ = a_i · (x_a − x_b), m.
  void coincide(int k, int i) {
    along(k, -a(i));
    row_.phi(k, inner::dot_from_end(a(i), xa - xb));
  }
  /// Row k: φ = s a_i · b_j, s = ±1; the sine of the angle that is missing to a right one.
  void perpendicular(int k, int i, int j, double s = 1) {
    about(k, -s * cross(a(i), b(j)));
    row_.phi(k, s * inner::dot_from_end(a(i), b(j)));
  }
  /// Rows k, k + 1: a_z and b_z parallel. φ = (a_y · b_z, −a_x · b_z), where closed about a_x and a_y.
  void parallel(int k) {
    perpendicular(k, 1, 2);
    perpendicular(k + 1, 0, 2, -1);
  }
  /// Rows k, k + 1, k + 2: The frames alike. With φ_i = ½ (a_j · b_l − a_l · b_j), (i, j, l) cyclic. For b turned against a
  /// by an angle θ about n it is −n_i sin θ, where closed about a_i.
  void alike(int k) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      about(k + i, 0.5 * (cross(a(l), b(j)) - cross(a(j), b(l))));
      row_.phi(k + i, 0.5 * (inner::dot_from_end(a(j), b(l)) - inner::dot_from_end(a(l), b(j))));
    }
  }

  /// u_k += direction · (v_b − v_a), at x_b.
  void along(int k, const Vec3& direction) {
    a_.along(k, -direction);
    b_.along(k, direction);
  }
  /// u_k += axis · (ω_b − ω_a).
  void about(int k, const Vec3& axis) {
    a_.about(k, -axis);
    b_.about(k, axis);
  }

 private:
  Row& row_;
  End a_, b_;
};

namespace inner {

/// Refuses an end that has no orientation where `what` needs one.
inline void expect_frame(const Anchor& end, const char* what, const char* which) {
  DELASSUS_EXPECT(end.has_frame,
                  std::string(what) + ": its " + which + " end needs an orientation; a particle has none");
}

/// For the laws whose two ends both need one.
void expect_frames(const auto& item, const char* what) {
  expect_frame(item.a, what, "first");
  expect_frame(item.b, what, "second");
}

}  // namespace inner
}  // namespace delassus
