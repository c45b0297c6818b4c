/// Sets of bodies that several workers factor and solve together.
#pragma once

#include <delassus/core/execution.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/rows/body_set.hpp>

#include <utility>

namespace delassus::inner {

/// A set with functions that take what its workers keep, a `Workers`, and an `Execution`; `node_compliances`
/// too where it knows the compliance of nodes. The bits are those of the functions without.
template <class S>
concept SharedSet = BodySet<S> && requires(S set, typename S::Workers& by, const Serial& execution,
                                           SystemScale scale, std::span<typename S::Velocity> x) {
  set.factor(scale, by, execution);
  std::as_const(set).solve(x, by, execution);
};

struct NothingKept {};
template <class Set>
struct kept_of_set {
  using type = NothingKept;
};
template <SharedSet Set>
struct kept_of_set<Set> {
  using type = typename Set::Workers;
};
/// What the workers keep of all sets of a world.
template <class World>
struct kept_of_sets;
template <template <class...> class World, class... Sets>
struct kept_of_sets<World<Sets...>> {
  using type = Pack<typename kept_of_set<Sets>::type...>;
};

/// A set as its workers answer for it; the rest is the set's own.
template <class Set, class E>
struct SetInParallel {
  using Velocity = typename Set::Velocity;
  using Scalar = typename Set::Scalar;
  Set& set;
  typename Set::Workers& by;
  const E& execution;

  bool is_coupled() const { return set.is_coupled(); }
  Index blocks() const { return set.blocks(); }
  void factor(SystemScale scale) { set.factor(scale, by, execution); }
  void solve(std::span<Velocity> x) const { std::as_const(set).solve(x, by, execution); }
};

}  // namespace delassus::inner
