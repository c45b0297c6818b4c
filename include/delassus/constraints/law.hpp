/// What a constraint law is.
#pragma once

#include <delassus/constraints/contact/wrapped_law.hpp>
#include <delassus/constraints/refinements.hpp>
#include <delassus/core/wrapping.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>

#include <concepts>
#include <type_traits>

namespace delassus {

/// A law has `rows` and `Item`, a type of its own by which the loop finds the law. It has linearize(item, world, row),
/// which writes H and φ, and
///
///   Vec<rows, T> solve_local(const Item&, const Mat<rows, rows, T>& W, const Vec<rows, T>& b) const.
///
/// That returns the impulse λ (N·s) that meets the law of the item alone. W is its own block of H A⁻¹ Hᵀ (1/kg). What its
/// rows would do without it is b = u − W λ (m/s), so that their velocity becomes u = W λ + b. The present λ is no argument.
///
/// A law that keeps something per item between sweeps says `template <class T> struct Memory`, and then it is
/// solve_local(item, W, b, Memory<T>&). With `bilateral` all rows are equalities, `kinds` says one RowKind a row. Rows whose
/// velocity is in rad/s are bits of `static constexpr unsigned turns`; the errors of others count in m/s. What else a law has
/// it declares in `refines`: see `constraints/refinements.hpp`.
///
/// For Newton's method, tangent(item, local) is `solve_local` for a W that is diagonal, friction rows alike. It replaces
/// local.lambda by the impulse that meets the law and returns −∂λ/∂d at it, rows × rows. An element of the generalised
/// derivative will do where there are several. An island with a law that has none is swept. A law whose cap on the impulse
/// is in its memory has tangent(item, local, memory).
///
/// With the slip |u_t| of its friction rows given, `tangent` is convex_tangent(item, local, slip), which makes the law the
/// projection on a convex set. A law without friction needs none.
template <class L>
concept ConstraintLaw = requires {
  typename L::Item;                                   // what the user adds, or collision detection fills
  { L::rows } -> std::convertible_to<int>;            // number of rows, a compile-time constant
};

template <class L>
concept RemembersBetweenSweeps = requires { typename L::template Memory<double>; };

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

/// What a wrapper overrides: O... after what the law inside does.
template <class Inside, class... O>
struct overrides_around;
template <class... I, class... O>
struct overrides_around<Overrides<I...>, O...> {
  using type = Overrides<I..., O...>;
};
template <class L, class... O>
using overrides_around_t = typename overrides_around<typename overrides_of<L>::type, O...>::type;

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

/// What a law does that does not refine this.
struct Unrefined {
  [[gnu::always_inline]] static constexpr void prepare(const auto&...) {}
  [[gnu::always_inline]] static constexpr void clamp(const auto&...) {}
  [[gnu::always_inline]] static constexpr bool is_sliding(const auto&...) { return false; }
  [[gnu::always_inline]] static constexpr void check(const auto&...) {}
  [[gnu::always_inline]] static constexpr void set_friction(const auto&...) {}
  [[gnu::always_inline]] static constexpr void set_restitution(const auto&...) {}
  [[gnu::always_inline]] static constexpr void soften(const auto&...) {}
};

/// Who is asked for a refinement: the law itself, the outermost of those inside it that declares it, or nobody.
template <unsigned what, class L>
  requires((declared_refinements<L> & what) != 0)
[[gnu::always_inline]] constexpr const L& who_refines(const L& law) {
  return law;
}
template <unsigned what, class L>
  requires((refinements_of<L> & what) == 0)
[[gnu::always_inline]] constexpr Unrefined who_refines(const L&) {
  return {};
}
template <unsigned what, class L>
  requires((refinements_of<L> & ~declared_refinements<L> & what) != 0)
[[gnu::always_inline]] constexpr const auto& who_refines(const L& law) {
  return who_refines<what>(law.law);
}

/// What a law is given: its item, and inside a contact the parameters of that.
template <class L>
  requires(!requires { typename L::wraps; })
[[gnu::always_inline]] constexpr const auto& given(const typename L::Item& item) {
  return item;
}
template <class L>
  requires requires { typename L::wraps; }
[[gnu::always_inline]] constexpr const auto& given(const typename L::Item& item) {
  return item.parameters;
}

template <class L, int R, class T, class M>
[[gnu::always_inline]] inline Vec<R, T> solve_local(const L& law, const typename L::Item& item, const Mat<R, R, T>& W,
                                                    const Vec<R, T>& b, M& memory) {
  const auto& solved = innermost(law);
  if constexpr (RemembersBetweenSweeps<innermost_t<L>>) return solved.solve_local(given<L>(item), W, b, memory);
  else return solved.solve_local(given<L>(item), W, b);
}

/// With the arguments that the law takes.
template <class L, class W, class M>
[[gnu::always_inline]] inline void prepare(const L& law, const typename L::Item& item, const W& own_block, double h, M& memory) {
  const auto& asked = who_refines<refine::prepare>(law);
  if constexpr (requires { asked.prepare(own_block, memory); }) asked.prepare(own_block, memory);
  else asked.prepare(given<L>(item), own_block, h, memory);
}
template <class L, class X, class M>
[[gnu::always_inline]] inline void clamp(const L& law, const typename L::Item& item, X& lambda, const M& memory) {
  const auto& asked = who_refines<refine::clamp>(law);
  if constexpr (requires { asked.clamp(given<L>(item), lambda, memory); }) asked.clamp(given<L>(item), lambda, memory);
  else asked.clamp(given<L>(item), lambda);
}

/// What `Contact` is put around: friction and the like, without items of its own.
template <class L>
concept LawOfContact = requires { L::rows, L::kinds, typename L::Parameters{}; } && !ConstraintLaw<L>;

/// A wrapper of contact laws around something else, inside Contact{...} or not.
template <class L>
concept HollowLaw = IsHollow<L> || requires { requires IsHollow<typename L::no_contact_law>; };

}  // namespace inner
}  // namespace delassus
