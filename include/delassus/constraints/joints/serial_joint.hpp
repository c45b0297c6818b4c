/// A joint of several axes in order: slides on the one end, then hinges to the other.
#pragma once

#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/joint_rows.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>

namespace delassus {
namespace inner {

/// Row k of a joint of so many slides is a force, the others are moments.
consteval unsigned moments_after(int forces, int rows) {
  unsigned turns = 0;
  for (int k = forces; k < rows; ++k) turns |= 1u << k;
  return turns;
}

}  // namespace inner

/// b moves along `slides` axes that a carries, and then turns about `hinges` axes, of which a carries the first, a_z, and b the
/// last, b_z. 6 − slides − hinges rows:
///
///   d · (x_a − x_b) + offset d · (a_z × b_z) = 0 for the directions d, fixed in a, that no slide has,
///   the frames alike; a_z and b_z parallel; a_z · b_z = cosine; nothing: without hinges, with one, two, three.
///
/// Three hinges meet in one point. Two may pass each other: x_a and x_b are where they are nearest, `offset` is their distance
/// along a_z × b_z. The rows are at most quadratic in the rotations, so that they keep what those of other joints keep. The angles are
/// those of `Turn` with one hinge, else `Precession`, `Nutation` and `Spin`; the ways are those of `Slide`. `SerialJoint<0, 2>` with the
/// default numbers is a `Universal`, `SerialJoint<2, 1>` a `Planar` whose hinge may lean.
template <int slides, int hinges>
struct SerialJoint : Bilateral<6 - slides - hinges, inner::moments_after(3 - slides, 6 - slides - hinges)> {
  static_assert(slides >= 0 && slides <= 3 && hinges >= 0 && hinges <= 3 && slides + hinges < 6,
                "delassus: SerialJoint<slides, hinges> has up to three of each, and not six together");
  static constexpr int rows = 6 - slides - hinges;
  using Base = Bilateral<rows, inner::moments_after(3 - slides, rows)>;  ///< the law of its rows

  /// Both ends need a frame.
  struct Item {
    /// Carries the slides and the first hinge, a_z.
    Anchor a{}, b{};             ///< is carried; its last hinge is b_z
    Vec3 slide = {1, 0, 0};      ///< axes of a: of one slide its direction, of two the normal of their plane, of any length
    double cosine = 0;           ///< a_z · b_z of two hinges, in (−1, 1)
    double offset = 0;           ///< of two hinges, m
  };

  static constexpr auto refines = Base::refines | refine::check;

  static void check(const Item& item) {
    inner::expect_frames(item, "SerialJoint");
    if constexpr (slides == 1 || slides == 2)
      DELASSUS_EXPECT(is_finite(item.slide) && norm(item.slide) > 0, "SerialJoint: slide must be finite and not zero");
    if constexpr (hinges == 2) {
      inner::expect_number(item.cosine > -1 && item.cosine < 1, "SerialJoint: cosine", item.cosine,
                           "must lie in (-1, 1): hinges that are parallel are no joint of two axes");
      inner::expect_number(std::isfinite(item.offset), "SerialJoint: offset", item.offset, "must be finite");
    }
  }

  void linearize(const Item& item, const auto& world, auto row) const {
    JointRows joint(item.a, item.b, world, row);
    int k = 0;
    const auto stay = [&](const Vec3& local) {
      const Vec3 d = joint.A * local;
      joint.along(k, -d);
      double phi = inner::dot_from_end(d, Vec3(joint.xa - joint.xb));
      if constexpr (hinges == 2) {
        const Vec3 side = joint.A * cross(local, unit_axis(2));  // linear in A, also where that is a mean of two
        joint.about(k, -item.offset * cross(side, joint.b(2)));
        phi += item.offset * inner::dot_from_end(side, joint.b(2));
      }
      row.phi(k++, phi);
    };
    if constexpr (slides == 0) {
      for (int i = 0; i < 3; ++i) stay(unit_axis(i));
    } else if constexpr (slides == 1) {
      const Vec3 e = item.slide / norm(item.slide), first = across(e);
      stay(first), stay(cross(e, first));
    } else if constexpr (slides == 2) {
      stay(Vec3(item.slide / norm(item.slide)));
    }
    if constexpr (hinges == 0) {
      joint.alike(k);
    } else if constexpr (hinges == 1) {
      joint.parallel(k);
    } else if constexpr (hinges == 2) {
      joint.about(k, -cross(joint.a(2), joint.b(2)));
      row.phi(k, inner::dot_from_end(joint.a(2), joint.b(2)) - item.cosine);
    }
  }

 private:
  /// A unit vector across a unit vector.
  static Vec3 across(const Vec3& e) {
    int least = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(e[k]) < std::abs(e[least])) least = k;
    const Vec3 c = cross(e, unit_axis(least));
    return c / norm(c);
  }
};

}  // namespace delassus
