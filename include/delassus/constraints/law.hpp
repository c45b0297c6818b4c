/// What a constraint law is.
#pragma once

#include <delassus/core/wrapping.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <concepts>
#include <type_traits>

namespace delassus {

/// A law has `rows` and `Item`, a type of its own by which the loop finds the law; linearize(item, world, row) writes H and φ; and
/// project(item, Local<rows>&) replaces local.lambda by one that meets the law.
///
/// A law that keeps something per item between sweeps says `template <class T> struct Memory`, and then has
/// prepare(W, memory), or prepare(item, W, h, memory) where a cap on the force makes one on the impulse, and
/// project(item, local, memory). Other refinements: `bilateral` (all rows equalities), `kinds` (one RowKind a row),
/// natural_map(item, λ, u, scale) (its own residual), clamp(item, λ) or clamp(item, λ, memory) (into its cone), speed(item)
/// (what its rows' velocity shall be, m/s), follow(item, world) (once a step, for what an item remembers of its pose),
/// λ = solve_local(item, b, memory), what `project` does, from the free velocity b = u − W λ alone, and tangent(item, local) (for
/// Newton's method).
template <class L>
concept ConstraintLaw = requires {
  typename L::Item;                                   // what the user adds, or collision detection fills
  { L::rows } -> std::convertible_to<int>;            // number of rows, a compile-time constant
};

template <class L>
concept RemembersBetweenSweeps = requires { typename L::template Memory<double>; };

template <class L>
concept Projects = requires(const L law, const typename L::Item item, Local<L::rows>& local) {
  { law.project(item, local) } -> std::same_as<void>;
} || requires(const L law, const typename L::Item item, Local<L::rows>& local,
              typename L::template Memory<double>& memory) {
  { law.project(item, local, memory) } -> std::same_as<void>;
};

/// tangent(item, local) is `project` for a W that is diagonal, friction rows alike, and without memory: it
/// replaces local.lambda by the impulse that meets the law and returns −∂λ/∂d at it, rows × rows. An element
/// of the generalised derivative will do where there are several. An island with a law that has none is
/// swept. A law whose cap on the impulse is in its memory has tangent(item, local, memory).
template <class L>
concept Differentiable = requires(const L law, const typename L::Item item, Local<L::rows>& local) {
  { law.tangent(item, local) } -> std::same_as<Mat<L::rows, L::rows>>;
}
|| requires(const L law, const typename L::Item item, Local<L::rows>& local,
            const typename L::template Memory<double>& memory) {
  { law.tangent(item, local, memory) } -> std::same_as<Mat<L::rows, L::rows>>;
};

/// The same of a law that contacts wrap, which gets its parameters in place of the item.
template <class L>
concept DifferentiableContact = requires(const L law, const typename L::Parameters p, Local<L::rows>& local) {
  { law.tangent(p, local) } -> std::same_as<Mat<L::rows, L::rows>>;
};

/// convex_tangent(parameters, local, slip) is `tangent` with the slip |u_t| of its friction rows given, which makes the
/// law the projection on a convex set. A law without friction needs none.
template <class L>
concept ConvexContact = requires(const L law, const typename L::Parameters p, Local<L::rows>& local) {
  { law.convex_tangent(p, local, 0.0) } -> std::same_as<Mat<L::rows, L::rows>>;
};

/// What a law changes in a step, `using overrides = Overrides<NewtonImpact>;`: each overrides stages by name, as a policy
/// does by its own `stages<Base>`, once however many laws name it.
template <class...>
struct Overrides {};

struct NewtonImpact;

namespace inner {

template <class Override, class... O>
consteval bool names_override(Overrides<O...>) {
  return (std::is_same_v<Override, O> || ...);
}

template <class L>
struct overrides_of {
  using type = Overrides<>;
};
template <class L>
  requires requires { typename L::overrides; }
struct overrides_of<L> {
  using type = typename L::overrides;
};

}  // namespace inner

/// A law whose items are made by collision detection.
template <class L>
concept ContactLaw = requires { requires L::is_contact; };

namespace inner {

struct NoMemory {};

template <class L, class T>
struct memory_of {
  using type = NoMemory;
};
template <RemembersBetweenSweeps L, class T>
struct memory_of<L, T> {
  using type = typename L::template Memory<T>;
};

template <class L, class T>
using memory_of_t = typename memory_of<L, T>::type;

/// Calls what the law has: with its memory or without.
template <class L, class W, class M>
void prepare(const L& law, const W& own_block, M& memory) {
  if constexpr (requires { law.prepare(own_block, memory); }) law.prepare(own_block, memory);
}
template <class L, class Item, class C, class M>
void project(const L& law, const Item& item, C& local, M& memory) {
  if constexpr (requires { law.project(item, local, memory); }) law.project(item, local, memory);
  else law.project(item, local);
}

/// What `Contact` is put around: friction and the like, without items of its own.
template <class L>
concept LawOfContact = requires { L::rows, L::kinds, typename L::Parameters{}; } && !ConstraintLaw<L>;

/// A wrapper of contact laws around something else, inside Contact{...} or not.
template <class L>
concept HollowLaw = IsHollow<L> || requires { requires IsHollow<typename L::no_contact_law>; };

/// One sentence for the first thing a law lacks.
template <class L>
consteval bool law_is_sound() {
  constexpr bool is_filled = !HollowLaw<L>;
  static_assert(is_filled,
                "delassus: Restitution, SequentialRestitution and Penalty go around a contact law, and their numbers come second: "
                "Contact{Restitution{Coulomb{.friction = 0.5}, 0.3}}, Contact{Penalty{Coulomb{}, 1e5, 50}}");
  constexpr bool is_around_a_law = !requires { typename L::no_contact_law; };
  static_assert(is_around_a_law || !is_filled,
                "delassus: Contact{...} takes a contact law, as in Contact{Coulomb{.friction = 0.5}}; this type lacks "
                "`rows`, `kinds` or `Parameters`");
  constexpr bool is_wrapped_once = !requires(const L& law) { typename std::remove_cvref_t<decltype(law.law)>::wraps::wraps; };
  static_assert(is_wrapped_once,
                "delassus: of Restitution, SequentialRestitution and Penalty a contact takes one, for only the outer one would be "
                "asked; take the other out (a Penalty bounces by its own stiffness and damping)");
  constexpr bool has_axis = !requires { typename L::no_coordinate; };
  static_assert(has_axis,
                "delassus: Limit, Motor and Drive act on one axis of a joint; write Motor<Turn>{} for an angle (rad), "
                "Motor<Slide>{} for a way (m); a Coupling on two, as in Coupling<Turn, Slide>{}");
  constexpr bool is_around_a_joint = !requires { typename L::no_joint; };
  static_assert(is_around_a_joint,
                "delassus: Breakable goes around a joint whose rows are forces and moments on its ends, as in Breakable<Hinge>{}; "
                "this one does not say so, by `acts`, or breaks already");
  constexpr bool has_shape = ConstraintLaw<L>, is_bare = LawOfContact<L>;
  static_assert(!is_bare,
                "delassus: the law of a contact stands within Contact{...}, as in Constraints{Contact{Coulomb{.friction = 0.5}}}");
  if constexpr (is_filled && is_around_a_law && is_around_a_joint && has_axis && !is_bare)
    static_assert(has_shape,
                  "delassus: a constraint law needs `static constexpr int rows` and a type `Item`; add what is missing");
  if constexpr (has_shape) {
    constexpr bool projects = Projects<L>;
    static_assert(projects,
                  "delassus: a constraint law needs void project(const Item&, Local<rows>&) const; add it");
    return projects && is_wrapped_once;
  } else {
    return false;
  }
}

}  // namespace inner
}  // namespace delassus
