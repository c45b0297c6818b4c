/// Whether a law has the refinements that it declares, and declares those that it has.
#pragma once

#include <delassus/constraints/inner/asked_law.hpp>
#include <delassus/constraints/inner/refinement_names.hpp>
#include <delassus/constraints/refinements.hpp>

namespace delassus::inner {

/// One sentence for the first declaration of a law that does not hold.
template <class A>
consteval bool has_what_it_declares() {
  constexpr unsigned said = declared_refinements<typename A::Law>;
  constexpr bool prepare = !(said & refine::prepare) || HasPrepare<A>;
  static_assert(prepare,
                "delassus: a law declares refine::prepare, but void prepare(const Mat<rows, rows, T>& W, Memory<T>&) const, "
                "or prepare(item, W, double h, Memory<T>&) const, is not there or has other types");
  constexpr bool clamp = !(said & refine::clamp) || HasClamp<A>;
  static_assert(clamp,
                "delassus: a law declares refine::clamp, but void clamp(item, Vec<rows, T>& lambda) const, outside contacts "
                "with const Memory<T>& or without, is not there or has other types");
  constexpr bool natural_map = !(said & refine::natural_map) || HasNaturalMap<A>;
  static_assert(natural_map,
                "delassus: a law declares refine::natural_map, but Vec<rows, T> natural_map(item, const Vec<rows, T>& lambda, "
                "const Vec<rows, T>& u, T scale) const is not there or has other types");
  constexpr bool natural_squares = !(said & refine::natural_squares) || HasNaturalSquares<A>;
  static_assert(natural_squares,
                "delassus: a law declares refine::natural_squares, but Vec<2, T> natural_squares(item, const Vec<rows, T>& "
                "lambda, const Vec<rows, T>& u, T scale) const is not there or has other types");
  constexpr bool projection_step = !(said & refine::projection_step) || HasProjectionStep<A>;
  static_assert(projection_step,
                "delassus: a law declares refine::projection_step, but Vec<rows, T> projection_step(item, const Mat<rows, rows, "
                "T>& W, const Vec<rows, T>& lambda, const Vec<rows, T>& u) const is not there or has other types");
  constexpr bool tangent = !(said & refine::tangent) || HasTangent<A>;
  static_assert(tangent,
                "delassus: a law declares refine::tangent, but Mat<rows, rows> tangent(item, Local<rows>&) const, with const "
                "Memory<T>& or without, is not there or has other types");
  constexpr bool convex_tangent = !(said & refine::convex_tangent) || HasConvexTangent<A>;
  static_assert(convex_tangent,
                "delassus: a law declares refine::convex_tangent, but Mat<rows, rows> convex_tangent(item, Local<rows>&, "
                "double slip) const is not there or has other types");
  constexpr bool is_sliding = !(said & refine::is_sliding) || HasIsSliding<A>;
  static_assert(is_sliding,
                "delassus: a law declares refine::is_sliding, but bool is_sliding(item, const Vec<rows, T>& lambda) const is "
                "not there or has other types");
  constexpr bool check = !(said & refine::check) || HasCheck<A>;
  static_assert(check,
                "delassus: a law declares refine::check, but void check(const Item&) const, in a contact void check() const, "
                "is not there or has other types");
  constexpr bool speed = !(said & refine::speed) || HasSpeed<A>;
  static_assert(speed,
                "delassus: a law declares refine::speed, but double speed(const Item&) const is not there or has other types");
  constexpr bool follow = !(said & refine::follow) || HasFollow<A>;
  static_assert(follow,
                "delassus: a law declares refine::follow, but void follow(Item&, const auto& world) const is not there or has "
                "other types");
  constexpr bool breaks = !(said & refine::breaks) || HasBreaks<A>;
  static_assert(breaks,
                "delassus: a law declares refine::breaks, but bool breaks(const Item&, const Vec<rows>& lambda, double h) "
                "const is not there or has other types");
  constexpr bool restitution = !(said & refine::restitution) || HasRestitution<A>;
  static_assert(restitution,
                "delassus: a law declares refine::restitution, but double restitution(const Item&) const is not there or has "
                "other types");
  constexpr bool set_friction = !(said & refine::set_friction) || HasSetFriction<A>;
  static_assert(set_friction,
                "delassus: a law declares refine::set_friction, but void set_friction(Parameters&, double) const is not there "
                "or has other types");
  constexpr bool set_restitution = !(said & refine::set_restitution) || HasSetRestitution<A>;
  static_assert(set_restitution,
                "delassus: a law declares refine::set_restitution, but void set_restitution(Parameters&, double) const is not "
                "there or has other types");
  return prepare && clamp && natural_map && natural_squares && projection_step && tangent && convex_tangent && is_sliding && check && speed &&
         follow && breaks && restitution && set_friction && set_restitution;
}

/// One sentence for the first function of a law that nobody would call.
template <class L, unsigned asked>
consteval bool declares_what_it_has() {
  constexpr unsigned stray = named_refinements<L>() & asked & ~declared_refinements<L>;
  static_assert(!(stray & refine::prepare),
                "delassus: a law has a member prepare that it does not declare, so that nobody would call it; add "
                "refine::prepare to its `refines`, or give it another name");
  static_assert(!(stray & refine::clamp),
                "delassus: a law has a member clamp that it does not declare, so that nobody would call it; add refine::clamp "
                "to its `refines`, or give it another name");
  static_assert(!(stray & refine::natural_map),
                "delassus: a law has a member natural_map that it does not declare, so that nobody would call it; add "
                "refine::natural_map to its `refines`, or give it another name");
  static_assert(!(stray & refine::natural_squares),
                "delassus: a law has a member natural_squares that it does not declare, so that nobody would call it; add "
                "refine::natural_squares to its `refines`, or give it another name");
  static_assert(!(stray & refine::tangent),
                "delassus: a law has a member tangent that it does not declare, so that nobody would call it; add "
                "refine::tangent to its `refines`, or give it another name");
  static_assert(!(stray & refine::convex_tangent),
                "delassus: a law has a member convex_tangent that it does not declare, so that nobody would call it; add "
                "refine::convex_tangent to its `refines`, or give it another name");
  static_assert(!(stray & refine::is_sliding),
                "delassus: a law has a member is_sliding that it does not declare, so that nobody would call it; add "
                "refine::is_sliding to its `refines`, or give it another name");
  static_assert(!(stray & refine::check),
                "delassus: a law has a member check that it does not declare, so that nobody would call it; add refine::check "
                "to its `refines`, or give it another name");
  static_assert(!(stray & refine::speed),
                "delassus: a law has a member speed that it does not declare, so that nobody would call it; add refine::speed "
                "to its `refines`, or give it another name");
  static_assert(!(stray & refine::follow),
                "delassus: a law has a member follow that it does not declare, so that nobody would call it; add "
                "refine::follow to its `refines`, or give it another name");
  static_assert(!(stray & refine::breaks),
                "delassus: a law has a member breaks that it does not declare, so that nobody would call it; add "
                "refine::breaks to its `refines`, or give it another name");
  static_assert(!(stray & refine::restitution),
                "delassus: a law has a member restitution that it does not declare, so that nobody would call it; add "
                "refine::restitution to its `refines`, or give it another name");
  static_assert(!(stray & refine::set_friction),
                "delassus: a law has a member set_friction that it does not declare, so that nobody would call it; add "
                "refine::set_friction to its `refines`, or give it another name");
  static_assert(!(stray & refine::set_restitution),
                "delassus: a law has a member set_restitution that it does not declare, so that nobody would call it; add "
                "refine::set_restitution to its `refines`, or give it another name");
  static_assert(!(stray & refine::projection_step),
                "delassus: a law has a member projection_step that it does not declare, so that nobody would call it; add "
                "refine::projection_step to its `refines`, or give it another name");
  static_assert(!(stray & refine::soften),
                "delassus: a law has a member soften that it does not declare, so that nobody would call it; add "
                "refine::soften to its `refines`, or give it another name");
  return stray == 0;
}

/// One sentence for the first refinement of a law that is not as it says: `asked` are those that it can have, `named` those whose
/// names its functions have for nothing else.
template <class A, unsigned asked, unsigned named = asked>
consteval bool refines_soundly() {
  constexpr bool is_asked = !(declared_refinements<typename A::Law> & ~asked);
  static_assert(is_asked,
                "delassus: a law declares a refinement that is not asked of it: speed, follow, breaks and restitution are of laws with items, "
                "set_friction, set_restitution and soften of laws inside Contact{...}; take it out of `refines`");
  return is_asked && has_what_it_declares<A>() && declares_what_it_has<typename A::Law, named>();
}

}  // namespace delassus::inner
