/// One sentence for the first thing a constraint law lacks.
#pragma once

#include <delassus/constraints/contact/wrapped_law.hpp>
#include <delassus/constraints/inner/refinement_checks.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/rows/row_kind.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// A law with solve_local, from its own block W (1/kg) and its velocity b without it (m/s); `Given` is its
/// item, or what a contact hands to the law inside.
template <class L, class Given, class T>
concept SolvesLocally = (RemembersBetweenSweeps<L> &&
                         requires(const L& law, const Given& given, const Mat<L::rows, L::rows, T>& W,
                                  const Vec<L::rows, T>& b, memory_of_t<L, T>& memory) {
                           { law.solve_local(given, W, b, memory) } -> std::same_as<Vec<L::rows, T>>;
                         }) ||
                        (!RemembersBetweenSweeps<L> &&
                         requires(const L& law, const Given& given, const Mat<L::rows, L::rows, T>& W,
                                  const Vec<L::rows, T>& b) {
                           { law.solve_local(given, W, b) } -> std::same_as<Vec<L::rows, T>>;
                         });

/// What solve_local was called before, in the way of `NamesOfRefinements`.
struct OldNames {
  int project, meet;
};
template <class L>
struct BesideOldNames : std::conditional_t<std::is_final_v<L>, NoMemory, L>, OldNames {};
template <class L, class Given, class T>
concept SolvesByOldName = !SolvesLocally<L, Given, T> &&
                          !(requires { &BesideOldNames<L>::project; } && requires { &BesideOldNames<L>::meet; });

/// A law, or the one inside a contact, answers with its impulse.
template <class L, class Given, class T>
consteval bool law_solves() {
  constexpr bool does = SolvesLocally<L, Given, T>, has_old = SolvesByOldName<L, Given, T>;
  static_assert(!has_old,
                "delassus: a constraint law needs Vec<rows> solve_local(item, W, b) const in the place of "
                "project(item, local); see "
                "docs/project/migration.md");
  static_assert(does || has_old,
                "delassus: a constraint law needs Vec<rows, T> solve_local(const Item&, const Mat<rows, "
                "rows, T>& W, const Vec<rows, "
                "T>& b) const, in a contact with its Parameters as item, and with Memory<T>& behind b if it "
                "has a Memory; add it");
  return does;
}

/// What laws with items and laws inside a contact can be asked for.
inline constexpr unsigned asked_of_all = refine::prepare | refine::clamp | refine::natural_map |
                                         refine::natural_squares | refine::tangent | refine::convex_tangent |
                                         refine::is_sliding | refine::check | refine::projection_step;
inline constexpr unsigned asked_of_items =
    asked_of_all | refine::speed | refine::follow | refine::breaks | refine::restitution;
inline constexpr unsigned asked_in_contact =
    asked_of_all | refine::set_friction | refine::set_restitution | refine::soften;

/// The laws inside a contact, from the outermost wrapper to the law that is solved.
template <class L, class Given, class Memory, class World>
consteval bool refine_inside() {
  if constexpr (requires { typename L::wraps; })
    return refines_soundly<AskedLaw<typename L::wraps, Given, Memory, World, true>, asked_in_contact>() &&
           refine_inside<typename L::wraps, Given, Memory, World>();
  else
    return true;
}

/// What a law is asked for is there. A contact itself has check and restitution, the laws inside it the rest.
template <class L, class World>
consteval bool law_answers() {
  using Solved = innermost_t<L>;
  using Memory = memory_of_t<Solved, typename World::Scalar>;
  using Given = std::remove_cvref_t<decltype(given<L>(std::declval<const typename L::Item&>()))>;
  constexpr bool is_contact = requires { typename L::wraps; };
  constexpr unsigned asked = is_contact ? unsigned(refine::restitution) : asked_of_items,
                     named = is_contact ? asked_of_items & ~(refine::check | refine::restitution)
                                        : asked_of_items;
  return law_solves<Solved, Given, typename World::Scalar>() &&
         refines_soundly<AskedLaw<L, typename L::Item, Memory, World, false>, asked, named>() &&
         refine_inside<L, Given, Memory, World>();
}

/// As many rows as solvers have room for, and a kind for each.
template <class L>
consteval bool law_has_rows() {
  constexpr bool has_rows = L::rows >= 1 && L::rows <= most_rows;
  static_assert(has_rows, "delassus: a constraint law has from 1 to 32 rows an item; change `rows`, or make two laws of it");
  constexpr bool has_kinds = !has_rows || !requires { L::kinds; } ||
                             requires { requires std::same_as<const std::array<RowKind, std::size_t(L::rows)>, decltype(L::kinds)>; };
  static_assert(has_kinds, "delassus: the `kinds` of a constraint law are one for each of its rows; write `static constexpr "
                           "std::array<RowKind, rows> kinds{...};`");
  return has_rows && has_kinds;
}

/// One sentence for the first thing a law lacks.
template <class L, class World>
consteval bool law_is_sound() {
  constexpr bool is_filled = !HollowLaw<L>;
  static_assert(is_filled,
                "delassus: Restitution, SequentialRestitution and Penalty go around a contact law, and their "
                "numbers come second: "
                "Contact{Restitution{Coulomb{.friction = 0.5}, 0.3}}, Contact{Penalty{Coulomb{}, 1e5, 50}}");
  constexpr bool is_around_a_law = !requires { typename L::no_contact_law; };
  static_assert(
      is_around_a_law || !is_filled,
      "delassus: Contact{...} takes a contact law, as in Contact{Coulomb{.friction = 0.5}}; this type lacks "
      "`rows`, `kinds` or `Parameters`");
  constexpr bool is_wrapped_once = !requires(const L& law) {
    typename std::remove_cvref_t<decltype(law.law)>::wraps::wraps;
  };
  static_assert(is_wrapped_once,
                "delassus: of Restitution, SequentialRestitution and Penalty a contact takes one, for only "
                "the outer one would be "
                "asked; take the other out (a Penalty bounces by its own stiffness and damping)");
  constexpr bool has_axis = !requires { typename L::no_coordinate; };
  static_assert(
      has_axis,
      "delassus: Limit, Motor and Drive act on one axis of a joint; write Motor<Turn>{} for an angle (rad), "
      "Motor<Slide>{} for a way (m); a Coupling on two, as in Coupling<Turn, Slide>{}");
  constexpr bool is_around_a_joint = !requires { typename L::no_joint; };
  static_assert(is_around_a_joint,
                "delassus: Breakable goes around a joint whose rows are forces and moments on its ends, as "
                "in Breakable<Hinge>{}; "
                "this one does not say so, by `acts`, or breaks already");
  constexpr bool has_shape = ConstraintLaw<L>, is_bare = LawOfContact<L>;
  static_assert(!is_bare,
                "delassus: the law of a contact stands within Contact{...}, as in "
                "Constraints{Contact{Coulomb{.friction = 0.5}}}");
  if constexpr (is_filled && is_around_a_law && is_around_a_joint && has_axis && !is_bare)
    static_assert(has_shape,
                  "delassus: a constraint law needs `static constexpr int rows` and a type `Item`; add what "
                  "is missing");
  if constexpr (has_shape && is_wrapped_once)
    return law_has_rows<L>() && law_answers<L, World>();
  else
    return false;
}

}  // namespace delassus::inner
