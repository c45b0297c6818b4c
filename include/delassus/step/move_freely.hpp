/// FreeMotion, and with it Advance where there are no constraints, in one pass: each body alone.
#pragma once

#include <delassus/core/fixed_array.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/step/free_motion.hpp>

#include <concepts>
#include <tuple>
#include <type_traits>

namespace delassus {

/// One block of a set, shown to an integrator as if it were the whole set.
template <class Blocks, class Velocity>
struct OneBlock {
  Blocks& blocks;
  Index b;
  Velocity v_next;

  FixedArray<Index, 1> active() const { return {0}; }  // the only place of p
  void add_forces(FixedArray<Velocity, 1>& p) const { blocks.add_force(b, p[0]); }
  void add_mass_times_velocity(FixedArray<Velocity, 1>& p, double s) const {
    blocks.add_mass_times_velocity(b, p[0], s);
  }
  void advance(double h) { blocks.advance(b, v_next, h, 0); }
  void advance_midpoint(double h) { blocks.advance(b, v_next, h, 0.5); }
  void advance_by_rotation_splitting(double h)
    requires requires { blocks.advance(b, v_next, h, RotationSplitting{}); }
  {
    blocks.advance(b, v_next, h, RotationSplitting{});
  }
};

/// An integrator that treats every block by itself says so by its own name, so that one derived from it has to say it anew:
/// `using each_block_alone = SymplecticEuler;`.
template <class I>
concept EachBlockAlone = std::same_as<typename I::each_block_alone, I>;

/// A set that can do a step block by block; is_separable(): no force couples its blocks now.
template <class S>
concept StepsByBlock = requires(S set, const S fixed, SystemScale scale) {
  { fixed.is_separable() } -> std::same_as<bool>;
  { set.by_block(scale) } -> std::same_as<typename S::Blocks>;
};

/// A set of which that is so whatever its bodies are.
template <class S>
concept AlwaysSeparable = requires { requires std::bool_constant<S::is_separable()>::value; };

namespace inner {

template <class World>
inline constexpr bool steps_by_block = false;
template <template <class...> class World, StepsByBlock... Sets>
inline constexpr bool steps_by_block<World<Sets...>> = true;

/// Calls f(block, b), block.v_next = v + A⁻¹ p, for every block of a set.
template <class Set, class I, class F>
void each_kicked(Set& set, const I& integrator, double h, F&& f) {
  auto blocks = set.by_block(integrator.scale(h));
  for (const Index b : set.active()) {
    OneBlock<decltype(blocks), typename Set::Velocity> block{blocks, b, {}};
    if (!blocks.moves(b)) [[unlikely]] {
      assign(block.v_next, blocks.velocity(b));
    } else {
      FixedArray<typename Set::Velocity, 1> p;
      set_all(p[0], typename Set::Scalar(-0.0));  // −0 + f is f for every f, 0 + f is not for f = −0
      integrator.impulse(block, p, h);
      block.v_next = blocks.velocity(b) + blocks.solve(b, p[0]);
    }
    f(block, b);
  }
}

}  // namespace inner

/// v_next = v + A⁻¹ p and q, v from it, without arrays in between: what `free_motion` and `advance` do, to
/// the bit but for the sign of a zero.
template <class Set, class I>
void move_freely(Set& set, const I& integrator, double h) {
  inner::each_kicked(set, integrator, h, [&](auto& block, Index) { integrator.advance(block, h); });
}

/// v_free and v_next = v + A⁻¹ p: the first half of it.
template <class Set, class I>
void kick(Set& set, const I& integrator, double h) {
  inner::each_kicked(set, integrator, h,
                     [&](auto& block, Index b) { assign(set.v_free[b], block.v_next), assign(set.v_next[b], block.v_next); });
}

/// FreeMotion to Advance of a whole step at once.
template <class Step>
  requires requires(Step& step) { step.end_clock(); }
void move_freely(Step& step) {
  step.world().each([&](auto& set, auto s) {
    if constexpr (AlwaysSeparable<std::remove_reference_t<decltype(set)>>) {
      move_freely(set, step.integrator(), step.h);
    } else if (set.is_separable()) {
      move_freely(set, step.integrator(), step.h);
    } else {
      delassus::free_motion(set, set, step.integrator(), inner::part<s>(step.scratch), step.h);
      set.v_next = set.v_free;
      step.integrator().advance(set, step.h);
    }
    step.summary.quarantined += set.quarantined();
  });
  step.end_clock();
}

}  // namespace delassus
