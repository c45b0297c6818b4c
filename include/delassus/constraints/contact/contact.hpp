/// A contact point between two bodies, under a contact law.
#pragma once

#include <delassus/constraints/contact/wrapped_law.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/rows/contact_record.hpp>

namespace delassus {

/// Two unit vectors that complete n to a right-handed frame (rows n, t₁, t₂). Any such choice jumps somewhere: this one
/// at n_z = −0.75, where no floor, wall or ceiling is. Source: [DuffEtAl2017], whose form jumps at n_z = 0, at every wall.
inline Mat3 contact_frame(const Vec3& n) {
  const double sign = n[2] < -0.75 ? -1.0 : 1.0;
  const double a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
  const double rows[3][3] = {{n[0], n[1], n[2]},
                             {1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]},
                             {b, sign + n[1] * n[1] * a, -n[1]}};
  Mat3 frame;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) frame(i, j) = rows[i][j];
  return frame;
}

namespace inner {

/// How many of a contact law's rows are of the velocity; what follows is of the rate of turn.
template <int rows>
inline constexpr int rows_along = rows < 3 ? rows : 3;

/// The impulse of a contact as a vector of the world, moments aside.
template <int rows, class T>
Vec3 world_impulse(const Mat3& frame, const Vec<rows, T>& lambda) {
  Vec3 sum = double(lambda[0]) * Vec3(frame(0, 0), frame(0, 1), frame(0, 2));
  for (int k = 1; k < rows_along<rows>; ++k) sum += double(lambda[k]) * Vec3(frame(k, 0), frame(k, 1), frame(k, 2));
  return sum;
}

}  // namespace inner

/// u = frame · (v_B − v_A) at the middle of the witnesses, or of each body's own point that will touch, φ_n = gap. The first row is normal, the next two tangent, and those of
/// a patch are taken `friction_arm` beside; a law with six rows goes on with (t₁, t₂, n) · (ω_B − ω_A). The law inside is solved and asked for what it refines, with
/// `item.parameters`.
template <class Law = inner::Absent>
struct Contact {
  using wraps = Law;
  static constexpr int rows = Law::rows;
  static constexpr auto kinds = Law::kinds;
  static constexpr unsigned turns = rows > inner::rows_along<rows> ? ~0u << inner::rows_along<rows> : 0u;  ///< see `turning_rows`
  static constexpr bool is_contact = true;  ///< read by the loop: collision detection makes the items
  static constexpr unsigned refines = inner::refinements_of<Law> & refine::set_restitution ? refine::restitution : 0u;
  using overrides = typename inner::overrides_of<Law>::type;

  Law law{};  ///< solved at each point, with its numbers where no pair has others

  /// One point; Detect fills it.
  struct Item {
    const ContactRecord* record = nullptr;  ///< in the loop's list of contacts, until the next Detect
    Vec3 point{0, 0, 0};                   ///< where the rows are taken, m, world
    double gap = 0;                         ///< m, negative in overlap
    Mat3 frame = diagonal_of<3>(1.0);  ///< rows n, t₁, t₂: unit vectors of the world
    typename Law::Parameters parameters{};
    Index result = -1;  ///< its place in the loop's list of contacts
  };

  void check() const { inner::who_refines<refine::check>(law).check(); }

  /// Records between other materials go to the next contact law that takes them.
  bool takes(Index, Index) const { return true; }

  void linearize(const Item& item, const auto& world, auto row) const {
    (void)world;
    const Vec3 half = 0.5 * item.record->travel;
    constexpr int along = inner::rows_along<rows>;
    const auto& axes = axes_along(item.frame);
    auto a = row.end(item.record->a, item.point - half);
    const bool is_of_patch = along > 1 && !is_zero(item.record->friction_arm);
    a.along(axes, -1);
    if (is_of_patch) shift(a, item, -1);
    if constexpr (rows > along) turn(a, item.frame, -1);
    auto b = row.end(item.record->b, item.point + half);
    b.along(axes, 1);
    if (is_of_patch) shift(b, item, 1);
    if constexpr (rows > along) turn(b, item.frame, 1);
    row.phi(0, item.gap);
    inner::who_refines<refine::soften>(law).soften(item.parameters, row, item.gap);
  }

  /// What a pair of materials says, as far as the law has it.
  void set_pair(typename Law::Parameters& parameters, const auto& pair) const {
    inner::who_refines<refine::set_friction>(law).set_friction(parameters, pair.friction);
    inner::who_refines<refine::set_restitution>(law).set_restitution(parameters, pair.restitution);
    if constexpr (requires { parameters.stiffness, parameters.damping; })
      if (pair.stiffness > 0) parameters.stiffness = pair.stiffness, parameters.damping = pair.damping;
  }
  /// e of this contact, where the law has one.
  double restitution(const Item& item) const { return item.parameters.restitution; }

 private:
  /// The first rows of a frame, as many as see the velocity of a point.
  static decltype(auto) axes_along(const Mat3& frame) {
    constexpr int along = inner::rows_along<rows>;
    if constexpr (along == 3) {
      return (frame);
    } else {
      Mat<along, 3> axes;
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < along; ++j) axes(j, k) = frame(j, k);
      return axes;
    }
  }
  /// From the velocity of a point to that of one beside it by r: t · (ω × r) = (r × t) · ω.
  static void shift(auto& end, const Item& item, double sign) {
    for (int k = 1; k < inner::rows_along<rows>; ++k)
      end.about(k, Vec3(sign * cross(item.record->friction_arm, Vec3(item.frame(k, 0), item.frame(k, 1), item.frame(k, 2)))));
  }
  /// The rows behind those of the velocity: t₁, t₂, n.
  static void turn(auto& end, const Mat3& frame, double sign) {
    for (int k = 3; k < rows; ++k) {
      const int axis = (k - 2) % 3;
      end.about(k, Vec3(sign * frame(axis, 0), sign * frame(axis, 1), sign * frame(axis, 2)));
    }
  }
};

/// Around what is no contact law; the loop's checks say so.
template <class Law>
  requires(!requires { Law::rows, Law::kinds, typename Law::Parameters{}; })
struct Contact<Law> {
  /// Read by the checks, which refuse it.
  using no_contact_law = Law;
  Law law{};  ///< what was given
};

/// `Contact{Coulomb{}}` is around a Coulomb.
template <class Law>
Contact(Law) -> Contact<Law>;

/// A contact law for the material pairs that `Pairs::takes(a, b)` names.
template <class Law, class Pairs>
struct ContactFor : Contact<Law> {
  bool takes(Index a, Index b) const { return Pairs::takes(a, b); }
};

}  // namespace delassus
