/// Tendons: a sum of coordinates is held, drawn by a spring, stopped or driven.
#pragma once

#include <delassus/constraints/joints/any_axis.hpp>
#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/constraints/joints/bounded.hpp>
#include <delassus/constraints/joints/stops.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/constraints/newton_impact.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/rows/soft.hpp>

#include <array>
#include <limits>
#include <string>

namespace delassus {

/// The share of one coordinate in the length of a tendon. It may be 0 for a while: the turns are counted all
/// the same, and the tendon goes when a body of the part is removed. A part that names no body and has none
/// is not there.
struct TendonPart {
  Anchor a{};                      ///< the end of the axis, whose z axis it is; of a length one point
  Anchor b{};                      ///< the other
  double coefficient = 0;          ///< of the coordinate in the length
  AxisKind kind = AxisKind::turn;  ///< which coordinate it is
  double position = 0;             ///< the coordinate at the start of the last step, rad over all turns or m

  bool is_used() const { return coefficient != 0; }  ///< it adds to the length
  bool is_given() const { return is_used() || a.owner != 0 || b.owner != 0; }  ///< it is there
};

namespace inner {

/// What the laws of tendons share: l = Σ coefficient · q of up to n coordinates, one row on all their bodies.
template <int n>
struct OfParts {
  static_assert(n >= 1, "delassus: a tendon has one part or more");
  using Parts = std::array<TendonPart, std::size_t(n)>;

  static void check_parts(const Parts& parts, const char* what) {
    bool any = false;
    for (const TendonPart& part : parts) {
      expect_number(std::isfinite(part.coefficient), (std::string(what) + ": coefficient").c_str(),
                    part.coefficient, "must be finite");
      expect_number(std::isfinite(part.position), (std::string(what) + ": position").c_str(), part.position,
                    "must be finite");
      if (!part.is_given()) continue;
      any = any || part.is_used();
      DELASSUS_EXPECT(is_axis_kind(part.kind), std::string(what) + ": kind " +
                                                   std::to_string(int(part.kind)) +
                                                   " of a part is no AxisKind; take one of its names");
      with_axis(part.kind, [&]<class C>() { C::check(part, what); });
    }
    DELASSUS_EXPECT(any, std::string(what) + ": no part has a coefficient that is not 0; a tendon needs one");
  }
  /// In the poses that `world` shows.
  static double length(const Parts& parts, const auto& world) {
    double sum = 0;
    for (const TendonPart& part : parts)
      if (part.is_used())
        sum += part.coefficient * axis_value(part.kind, {part.a, part.b, world}, part.position);
    return sum;
  }
  static void follow_parts(Parts& parts, const auto& world) {
    for (TendonPart& part : parts)
      if (part.is_given()) part.position = axis_value(part.kind, {part.a, part.b, world}, part.position);
  }
  /// u_k += l̇ in rows k = first … last; returns l.
  static double write(const Parts& parts, const auto& world, auto& row, int first = 0, int last = 0) {
    double sum = 0;
    for (const TendonPart& part : parts) {
      if (!part.is_used()) continue;
      JointRows rows(part.a, part.b, world, row);
      for (int k = first; k <= last; ++k) write_axis(part.kind, rows, k, part.coefficient);
      sum += part.coefficient * axis_value(part.kind, rows, part.position);
    }
    return sum;
  }
};

}  // namespace inner

/// l = Σ coefficient · q, of up to n coordinates, is `rest`; with stiffness k or damping c the row is the
/// spring f = −k (l − rest) − c l̇. With axes of joints it couples them, also those of one body; with
/// `AxisKind::length` it is a rope from point to point. One row on all bodies that it names, of which errors
/// count in rad. The joints themselves are added beside it.
template <int n>
struct Tendon : Bilateral<1, 1u>, inner::OfParts<n> {
  /// The coordinates, and what their sum shall be.
  struct Item {
    std::array<TendonPart, std::size_t(n)> parts{};  ///< those that are used, in any place
    double rest = 0;                                 ///< of the length, rad or m
    double stiffness = 0;  ///< k, force to the length by length: 0, or 1e-20 to 1e20
    double damping = 0;    ///< c: 0, or 1e-20 to 1e20; without k and c the length is held
  };

  static constexpr auto refines = Bilateral<1, 1u>::refines | refine::check | refine::follow;

  static void check(const Item& item) {
    inner::OfParts<n>::check_parts(item.parts, "Tendon");
    inner::check_soft_number(item.stiffness, "Tendon: stiffness", "N/m or N·m/rad");
    inner::check_soft_number(item.damping, "Tendon: damping", "N·s/m or N·m·s/rad");
    inner::expect_number(std::isfinite(item.rest), "Tendon: rest", item.rest, "must be finite");
  }
  void follow(Item& item, const auto& world) const { this->follow_parts(item.parts, world); }
  void linearize(const Item& item, const auto& world, auto row) const {
    row.phi(0, this->write(item.parts, world, row) - item.rest);
    if (inner::is_spring(item.stiffness, item.damping)) row.soft(0, item.stiffness, item.damping);
  }
};

/// lower ≤ l ≤ upper for the length of a tendon, see `Limit`.
template <int n>
struct TendonLimit : inner::Stops, inner::OfParts<n> {
  static constexpr unsigned turns = ~0u;  ///< rows may be in rad/s
  static constexpr auto refines =
      inner::Stops::refines | refine::check | refine::follow | refine::restitution;
  using overrides = Overrides<NewtonImpact>;

  /// The coordinates and their stops.
  struct Item {
    std::array<TendonPart, std::size_t(n)> parts{};  ///< the coordinates
    double lower = -std::numeric_limits<double>::infinity();  ///< rad or m
    double upper = std::numeric_limits<double>::infinity();   ///< rad or m, at least `lower`
    double restitution = 0;                                   ///< e in [0, 1]
    double margin = 0.5;  ///< how near a stop is when it has a row, rad or m
    double length = 0;    ///< l at the start of the last step
    double way = 0;       ///< what the last step added to it
  };

  static void check(const Item& item) {
    inner::OfParts<n>::check_parts(item.parts, "TendonLimit");
    DELASSUS_EXPECT(item.lower <= item.upper, "TendonLimit: lower " + inner::text(item.lower) +
                                                  " must be <= upper " + inner::text(item.upper));
    inner::expect_zero_to_one("TendonLimit: restitution", item.restitution);
    inner::expect_number(item.margin >= 0 && std::isfinite(item.length), "TendonLimit: margin", item.margin,
                         "must be >= 0 and length finite");
  }
  void follow(Item& item, const auto& world) const {
    this->follow_parts(item.parts, world);
    const double now = this->length(item.parts, world);
    item.way = now - item.length;
    item.length = now;
  }
  void linearize(const Item& item, const auto& world, auto row) const {
    const double reach = item.margin + 2 * std::abs(item.way);
    const bool is_low = reach > item.length - item.lower, is_high = reach > item.upper - item.length;
    if (!is_low && !is_high) return;
    const double length = this->write(item.parts, world, row, is_low ? 0 : 1, is_high ? 1 : 0);
    if (is_low) row.phi(0, length - item.lower);
    if (is_high) row.phi(1, length - item.upper);
  }
  double restitution(const Item& item) const { return item.restitution; }
};

/// A force on the length of a tendon with a cap: with stiffness k or damping c that of a `Drive`, without
/// them that of a `Motor`, which with speed 0 is dry friction.
template <int n>
struct TendonMotor : Bounded, inner::OfParts<n> {
  static constexpr unsigned turns = ~0u;  ///< rows may be in rad/s

  /// The coordinates, where their sum shall be, and how hard it is drawn there.
  struct Item {
    std::array<TendonPart, std::size_t(n)> parts{};  ///< the coordinates
    double target = 0;                                           ///< of the length, rad or m
    double stiffness = 0;                                        ///< k ≥ 0
    double damping = 0;                                          ///< c ≥ 0
    double max_force = std::numeric_limits<double>::infinity();  ///< N·m or N, to a length of coefficient 1
    double speed = 0;  ///< of the target, or of a motor, rad/s or m/s
  };

  static constexpr auto refines = Bounded::refines | refine::check | refine::follow | refine::speed;

  static void check(const Item& item) {
    inner::OfParts<n>::check_parts(item.parts, "TendonMotor");
    inner::check_soft_number(item.stiffness, "TendonMotor: stiffness", "N/m or N·m/rad");
    inner::check_soft_number(item.damping, "TendonMotor: damping", "N·s/m or N·m·s/rad");
    DELASSUS_EXPECT(std::isfinite(item.target) && std::isfinite(item.speed),
                    "TendonMotor: target " + inner::text(item.target) + " and speed must be finite");
    check_cap(item.max_force, "TendonMotor", "N·m or N");
  }
  double speed(const Item& item) const { return item.speed; }
  void follow(Item& item, const auto& world) const { this->follow_parts(item.parts, world); }
  void linearize(const Item& item, const auto& world, auto row) const {
    row.phi(0, this->write(item.parts, world, row) - item.target);
    if (inner::is_spring(item.stiffness, item.damping)) row.soft(0, item.stiffness, item.damping);
  }
};

}  // namespace delassus
