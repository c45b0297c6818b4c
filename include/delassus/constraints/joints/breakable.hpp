/// A wrapper that lets a joint break where it carries too much.
#pragma once

#include <delassus/constraints/law.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/math/linear.hpp>

#include <limits>

namespace delassus {

/// `Breakable<Hinge>::Item{{a, b}, 500, 20}`: breaks when |F| > 500 N or |M| > 20 N·m, the means of a step,
/// moments about the joint's point. It carries that step to its end, stands in
/// `loop.broken<Breakable<Hinge>>()` after it with its impulse, and is gone when the next step begins. The
/// joint says `acts`, as `Reaction` wants it.
template <class Joint = inner::Absent>
struct Breakable : Joint {
  /// What the joint has, and what it bears.
  struct Item : Joint::Item {
    double max_force = std::numeric_limits<double>::infinity();   ///< N
    double max_moment = std::numeric_limits<double>::infinity();  ///< N·m
  };

  static constexpr auto refines = inner::declared_refinements<Joint> | refine::check | refine::breaks;

  void check(const Item& item) const {
    inner::who_refines<refine::check>(static_cast<const Joint&>(*this)).check(item);
    DELASSUS_EXPECT(item.max_force > 0 && item.max_moment > 0,
                    "Breakable: max_force " + inner::text(item.max_force) + " N and max_moment " +
                        inner::text(item.max_moment) + " N·m must be > 0");
  }

  /// Whether this step's λ/h was more than the joint bears, as a force or as a moment.
  bool breaks(const Item& item, const Vec<Joint::rows>& lambda, double h) const {
    double force = 0, moment = 0;
    for (int k = 0; k < Joint::rows; ++k) (Joint::acts[k] < 3 ? force : moment) += lambda[k] * lambda[k];
    return std::sqrt(force) > h * item.max_force || std::sqrt(moment) > h * item.max_moment;
  }
};

/// Around what does not say of its rows whether they are forces or moments, or breaks already; the loop's checks say so.
template <class Joint>
  requires(!requires { Joint::acts; } || refines<Joint>(refine::breaks))
struct Breakable<Joint> {
  /// Read by the checks, which refuse it.
  using no_joint = Joint;
  /// Takes anything, so that the checks can speak.
  explicit Breakable(const auto&...) {}
};

/// `Breakable{Hinge{}}`.
template <class Joint>
Breakable(Joint) -> Breakable<Joint>;

}  // namespace delassus
