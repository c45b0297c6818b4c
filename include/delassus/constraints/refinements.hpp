/// What a constraint law refines: the functions that it has besides those of every law, named once.
#pragma once

#include <concepts>

namespace delassus {

/// `static constexpr auto refines = refine::clamp | refine::natural_map;` in a law: it has these functions, all const. Who does not
/// say it is not asked, and a name that is declared and missing, has other types, or is there and not declared is refused by one
/// sentence. A law that derives from another adds to what that one has: `Hinge::refines | refine::breaks`.
///
/// `item` is the law's Item; a law inside Contact{...} gets its Parameters instead. R is `rows`, λ and u are Vec<R, T>; a law with
/// Memory<T> may have it as a last argument where that stands in brackets.
namespace refine {

/// One bit a function.
enum Refinement : unsigned {
  prepare = 1 << 0,           ///< void prepare(const Mat<R, R, T>& W, Memory<T>&), or prepare(item, W, h, Memory<T>&): once a step and W
  clamp = 1 << 1,             ///< void clamp(item, Vec<R, T>& λ [, const Memory<T>&]): into its cone; in a contact without memory
  natural_map = 1 << 2,       ///< Vec<R, T> natural_map(item, λ, u, T scale [, T of_turns]): s λ − P(s λ − ũ), zero where λ and u meet the law; s in rows in m/s [and in those in rad/s]
  natural_squares = 1 << 3,   ///< Vec<2, T> natural_squares(item, λ, u, T scale): its square at `scale` and at 1
  tangent = 1 << 4,           ///< Mat<R, R> tangent(item, Local<R>& c [, const Memory<T>&]): see `constraints/law.hpp`
  convex_tangent = 1 << 5,    ///< Mat<R, R> convex_tangent(item, Local<R>& c, double slip)
  is_sliding = 1 << 6,        ///< bool is_sliding(item, λ): of contacts, for who reads them
  check = 1 << 7,             ///< void check(item) throws what is wrong with an item that is added; in a contact check(), with the numbers of the law
  speed = 1 << 8,             ///< double speed(item): what the velocity of its rows shall be, m/s or rad/s
  follow = 1 << 9,            ///< void follow(Item&, world): once a step, for what an item remembers of its pose
  breaks = 1 << 10,           ///< bool breaks(item, Vec<R> λ, double h): the impulse of this step was too much
  restitution = 1 << 11,      ///< double restitution(item): e in [0, 1], with `using overrides = Overrides<NewtonImpact>;`
  set_friction = 1 << 12,     ///< void set_friction(Parameters&, double): what a pair of materials says; in a contact
  set_restitution = 1 << 13,  ///< void set_restitution(Parameters&, double): the same of a wrapper inside Contact{...}
  soften = 1 << 14,           ///< void soften(const Parameters&, row, double gap): of such a wrapper, when the rows of a contact are written
  projection_step = 1 << 15,  ///< Vec<R, T> projection_step(item, const Mat<R, R, T>& W, λ, u): P(λ − M⁻¹ ũ) in the metric of an M ≥ W, which leaves what meets the law
};

}  // namespace refine

namespace inner {

/// What a law itself declares.
template <class L>
inline constexpr unsigned declared_refinements = 0;
template <class L>
  requires requires {
    { L::refines } -> std::convertible_to<unsigned>;
  }
inline constexpr unsigned declared_refinements<L> = L::refines;

/// The same, and what the laws inside it declare.
template <class L>
inline constexpr unsigned refinements_of = declared_refinements<L>;
template <class L>
  requires requires { typename L::wraps; }
inline constexpr unsigned refinements_of<L> = declared_refinements<L> | refinements_of<typename L::wraps>;

}  // namespace inner

/// Whether a law refines this: `refines<BallJoint>(refine::clamp)`. Of a contact, whether the law inside does.
template <class Law>
consteval bool refines(unsigned what) {
  return (inner::refinements_of<Law> & what) == what;
}

}  // namespace delassus
