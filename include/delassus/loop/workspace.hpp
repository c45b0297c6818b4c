/// The arrays of a loop that has constraints; one that has none has no workspace.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/loop/activity.hpp>
#include <delassus/loop/stages/detect.hpp>
#include <delassus/loop/stages/move_freely.hpp>
#include <delassus/rows/islands.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/island_problem.hpp>
#include <delassus/solvers/law_book.hpp>
#include <delassus/solvers/solve_report.hpp>

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <vector>

namespace delassus {

/// An integrator that solves for joints and bodies together brings `WholeStep<World, Laws, Rows>`, whose solve(world, laws,
/// rows, integrator, h) leaves v_next and λ, and returns a SolveReport. One that moves each block alone where there are no
/// constraints needs it only where there are.
template <class I, bool has_constraints>
inline constexpr bool solves_whole_step = requires { requires I::solves_whole_step; } && (has_constraints || !EachBlockAlone<I>);

}  // namespace delassus

namespace delassus::inner {

template <class World>
struct widths_of;
template <class... S>
struct widths_of<World<S...>> {
  using type = Widths<S::width...>;
  using Scratch = std::tuple<Array<typename S::Velocity>...>;
};

template <class W, int R, class Widths = typename widths_of<W>::type>
struct pool_rows_of;
template <class W, int R, int... w>
struct pool_rows_of<W, R, Widths<w...>> {
  using type = PoolRows<R, typename W::Scalar, w...>;
};
/// The rows that a law with R of them has over a world.
template <class W, int R>
using PoolRowsOf = typename pool_rows_of<W, R>::type;

template <class L>
inline constexpr bool law_restitutes = requires(const L& law, const typename L::Item& i) { law.restitution(i); };

/// The law inside `Contact` lets impacts go from contact to contact.
template <class L>
inline constexpr bool passes_impacts_on =
    requires(const L& law) { requires std::remove_cvref_t<decltype(law.law)>::passes_impacts_on; };

template <class World, class Laws>
struct rows_of;
template <class World, class... L>
struct rows_of<World, Constraints<L...>> {
  using type = RowSystem<typename World::Scalar, typename widths_of<World>::type, L::rows...>;
  static constexpr bool restitutes = (law_restitutes<L> || ...);
  static constexpr bool passes_impacts_on = (inner::passes_impacts_on<L> || ...);
};

/// Takes no room, once for each thing that is absent.
template <int which>
struct Nothing {};

template <class Activity, class World, class Laws>
struct activity_state {
  using type = Nothing<6>;
};
template <class Activity, class World, class Laws>
  requires has_dormant<Activity>
struct activity_state<Activity, World, Laws> {
  using type = typename Activity::template State<World, Laws>;
};

template <class I, class World, class Laws, class Rows>
struct whole_step {
  using type = Nothing<7>;
};
template <class I, class World, class Laws, class Rows>
  requires(solves_whole_step<I, (Laws::pool_count > 0)>)
struct whole_step<I, World, Laws, Rows> {
  using type = typename I::template WholeStep<World, Laws, Rows>;
};

/// A scheme that does a step in parts brings what it needs for that, `Parts`.
template <class Scheme, class World, class Laws, class Rows>
struct parts_of {
  using type = Nothing<8>;
};
template <class Scheme, class World, class Laws, class Rows>
  requires requires { typename Scheme::template Parts<World, Laws, Rows>; }
struct parts_of<Scheme, World, Laws, Rows> {
  using type = typename Scheme::template Parts<World, Laws, Rows>;
};

/// Arrays of a step; `reset` keeps their capacity, so a warm step allocates nothing.
template <class World, class Laws, class Compliance, class Solver, class Integrator, class Stabilisation,
          class Scheme, class Activity>
struct Workspace {
  using Rows = typename rows_of<World, Laws>::type;
  using Operator = typename Compliance::template Operator<Rows>;
  static constexpr bool restitutes = rows_of<World, Laws>::restitutes;
  static constexpr bool passes_impacts_on = rows_of<World, Laws>::passes_impacts_on;
  static constexpr bool at_midpoint = requires { requires Integrator::linearises_at_midpoint; };
  static constexpr bool has_dormant = delassus::has_dormant<Activity>;
  static constexpr bool predicts = requires { requires Scheme::predicts; };
  static constexpr bool projects_position = requires { requires Stabilisation::projects_position; };

  explicit Workspace(const Laws& laws) : book(laws) {}

  Rows rows;
  Islands<Laws::pool_count> islands;
  Operator W;
  LawBook<Laws, typename World::Scalar> book;
  typename Solver::template Workspace<Rows> solver;
  Array<SolveReport> reports;  ///< of the islands, in their order
  Array<char> is_sick;
  std::array<Census, std::size_t(World::set_count)> census;
  ContactBook contacts;
  Materials materials;
  [[no_unique_address]] std::conditional_t<at_midpoint, Rows, Nothing<1>> at_start;
  [[no_unique_address]] std::conditional_t<at_midpoint, Impulses<Rows>, Nothing<10>> fade;
  [[no_unique_address]] std::conditional_t<restitutes, Impulses<Rows>, Nothing<2>> bounce;
  [[no_unique_address]] std::conditional_t<restitutes || projects_position, std::array<Impulses<Rows>, 2>, Nothing<3>> aside;
  [[no_unique_address]] typename activity_state<Activity, World, Laws>::type activity;
  [[no_unique_address]] std::conditional_t<predicts, Impulses<Rows>, Nothing<5>> predicted;
  [[no_unique_address]] typename whole_step<Integrator, World, Laws, Rows>::type whole_step;
  [[no_unique_address]] std::conditional_t<projects_position, typename widths_of<World>::Scratch, Nothing<4>> displacement;
  [[no_unique_address]] typename parts_of<Scheme, World, Laws, Rows>::type parts;
  [[no_unique_address]] std::conditional_t<passes_impacts_on, std::vector<Vec3>, Nothing<9>> impacts;
};

/// A loop without constraints, or one whose parts do not fit together and which therefore never steps.
template <class World, class C, class S, class I, class St, class Sc, class Ac>
struct Workspace<World, Constraints<>, C, S, I, St, Sc, Ac> {
  using Rows = typename rows_of<World, Constraints<>>::type;
  explicit Workspace(const auto&) {}
  [[no_unique_address]] typename inner::whole_step<I, World, Constraints<>, Rows>::type whole_step;
  [[no_unique_address]] typename parts_of<Sc, World, Constraints<>, Rows>::type parts;
};

}  // namespace delassus::inner
