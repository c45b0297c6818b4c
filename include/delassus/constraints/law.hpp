/// What a constraint law is.
#pragma once

#include <delassus/constraints/contact/wrapped_law.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <concepts>
#include <type_traits>

namespace delassus {

/// A law has `rows` and `Item`, a type of its own by which the loop finds the law; linearize(item, world, row) writes H and φ; and
///
///   Vec<rows, T> solve_local(const Item&, const Mat<rows, rows, T>& W, const Vec<rows, T>& b) const
///
/// returns the impulse λ (N·s) that meets the law of the item alone: W is its own block of H A⁻¹ Hᵀ (1/kg), b = u − W λ what its rows
/// would do without it (m/s), so that their velocity becomes u = W λ + b. The present λ is no argument.
///
/// A law that keeps something per item between sweeps says `template <class T> struct Memory`, and then has
/// prepare(W, memory), or prepare(item, W, h, memory) where a cap on the force makes one on the impulse, and
/// solve_local(item, W, b, memory). Other refinements: `bilateral` (all rows equalities), `kinds` (one RowKind a row),
/// natural_map(item, λ, u, scale) (its own residual), clamp(item, λ) or clamp(item, λ, memory) (into its cone), speed(item)
/// (what its rows' velocity shall be, m/s), follow(item, world) (once a step, for what an item remembers of its pose),
/// and tangent(item, local) (for Newton's method).
template <class L>
concept ConstraintLaw = requires {
  typename L::Item;                                   // what the user adds, or collision detection fills
  { L::rows } -> std::convertible_to<int>;            // number of rows, a compile-time constant
};

template <class L>
concept RemembersBetweenSweeps = requires { typename L::template Memory<double>; };

/// tangent(item, local) is `solve_local` for a W that is diagonal, friction rows alike, and without memory: it
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
template <class L, class Given, int R, class T, class M>
[[gnu::always_inline]] inline Vec<R, T> solve_local(const L& law, const Given& given, const Mat<R, R, T>& W, const Vec<R, T>& b,
                                                    M& memory) {
  if constexpr (RemembersBetweenSweeps<L>) return law.solve_local(given, W, b, memory);
  else return law.solve_local(given, W, b);
}

/// A law with solve_local, from its own block W (1/kg) and its velocity b without it (m/s); `Given` is its item, or what a contact
/// hands to the law inside.
template <class L, class Given, class T>
concept SolvesLocally =
    (RemembersBetweenSweeps<L> && requires(const L& law, const Given& given, const Mat<L::rows, L::rows, T>& W,
                                           const Vec<L::rows, T>& b, memory_of_t<L, T>& memory) {
      { law.solve_local(given, W, b, memory) } -> std::same_as<Vec<L::rows, T>>;
    }) || (!RemembersBetweenSweeps<L> &&
           requires(const L& law, const Given& given, const Mat<L::rows, L::rows, T>& W, const Vec<L::rows, T>& b) {
             { law.solve_local(given, W, b) } -> std::same_as<Vec<L::rows, T>>;
           });

/// What solve_local was called before. A name that a class inherits twice is ambiguous, whatever overloads or templates it has.
struct OldSolve {
  int project, meet;
};
template <class L>
struct BesideOldSolve : L, OldSolve {};
template <class L>
concept HasOldSolve = !(requires { &BesideOldSolve<L>::project; } && requires { &BesideOldSolve<L>::meet; });

/// What `Contact` is put around: friction and the like, without items of its own.
template <class L>
concept LawOfContact = requires { L::rows, L::kinds, typename L::Parameters{}; } && !ConstraintLaw<L>;

/// A wrapper of contact laws around something else, inside Contact{...} or not.
template <class L>
concept HollowLaw = IsHollow<L> || requires { requires IsHollow<typename L::no_contact_law>; };

/// What the law inside all wrappers is given: an item, and of a contact its parameters.
template <class L>
[[gnu::always_inline]] constexpr const auto& given(const typename L::Item& item) {
  if constexpr (requires { typename L::wraps; }) return item.parameters;
  else return item;
}

/// A law, or the one inside a contact, answers with its impulse.
template <class L, class Given, class T>
consteval bool law_solves() {
  constexpr bool does = SolvesLocally<L, Given, T>, has_old = !does && HasOldSolve<L>;
  static_assert(!has_old,
                "delassus: a constraint law needs Vec<rows> solve_local(item, W, b) const in the place of project(item, local); see "
                "docs/migration.md");
  static_assert(does || has_old,
                "delassus: a constraint law needs Vec<rows, T> solve_local(const Item&, const Mat<rows, rows, T>& W, const Vec<rows, T>& b) "
                "const, in a contact with its Parameters as item, and with Memory<T>& behind b if it has a Memory; add it");
  return does;
}

/// One sentence for the first thing a law lacks; T is the scalar of the rows.
template <class L, class T>
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
    if constexpr (!is_wrapped_once) return false;
    else return law_solves<innermost_t<L>, std::remove_cvref_t<decltype(given<L>(std::declval<const typename L::Item&>()))>, T>();
  } else {
    return false;
  }
}

}  // namespace inner
}  // namespace delassus
