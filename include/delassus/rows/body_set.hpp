/// What the loop, the builders and the laws may ask of a body set.
#pragma once

#include <delassus/rows/anchor.hpp>

#include <concepts>
#include <cstdint>
#include <span>

namespace delassus {

/// How the system matrix A mixes mass M, damping D = −∂f/∂v and stiffness K = −∂f/∂q of a set: A = mass M + damping D
/// + stiffness K. The integrator chooses; A is symmetric positive definite by contract.
struct SystemScale {
  double mass = 1;
  double damping = 0;
  double stiffness = 0;
};

/// A structure of arrays of bodies of one kind, `width` velocities per block. Blocks are bodies or nodes.
///
/// v: start of the step, m/s and rad/s; v_free: after the free motion; v_next: after the corrective motion.
/// Where A has no entries between blocks, solve_block(b, x) gives A_b⁻¹ x for one or more columns.
template <class S>
concept BodySet = requires(S set, const S fixed, const Anchor anchor, Index b, SystemScale scale, double h, Vec3 x,
                           std::span<Vec<S::width, typename S::Scalar>> p) {
  { fixed.blocks() } -> std::same_as<Index>;      // how many blocks there are, removed ones included
  { fixed.moves(b) } -> std::same_as<bool>;       // A⁻¹ ≠ 0: the block answers to impulses
  { set.factor(scale) } -> std::same_as<void>;    // makes A and what solves with it
  { fixed.add_forces(p) } -> std::same_as<void>;  // p += f(q, v), N and N·m
  { fixed.anchor_blocks(anchor) } -> std::same_as<int>;                                        // blocks behind a point
  { fixed.along(anchor, 0, x, x) } -> std::same_as<Vec<S::width, typename S::Scalar>>;  // row of H of one of them
  { fixed.point(anchor) } -> std::same_as<Vec3>;  // where an anchor is in the world, m
  { set.advance(h) } -> std::same_as<void>;       // q, v from v_next
};

/// A set whose M⁻¹ is known by its parts: 1/m, and R I⁻¹ Rᵀ about `centre(b)` (m) of what turns.
template <class S>
concept HasInverseInertia = BodySet<S> && requires(const S set) {
  { set.inverse_mass(0) } -> std::same_as<typename S::Scalar>;
  requires S::width == 3 || requires {
    set.inverse_inertia(0);
    set.centre(0);
  };
};

/// While this stays as it is, so does who is there of a set: anchors that were current are.
struct SetVersion {
  std::uint32_t owner = 0, removals = 0;
  Index blocks = -1;
  bool operator==(const SetVersion&) const = default;
};

/// A set whose blocks have orientation: joints may ask for their frames and rates of turn.
template <class S>
concept FramedSet = BodySet<S> && requires(const S set, const Anchor anchor, Vec3 axis) {
  { set.frame(anchor) } -> std::same_as<Quat>;
  { set.about(anchor, 0, axis) } -> std::same_as<Vec<S::width, typename S::Scalar>>;
};

/// In place of a share of velocities: bodies turn freely by exact turns about axes of their own (`advance_by_rotation_splitting`).
struct RotationSplitting {};

namespace inner {

/// The velocity that moves q: `old_share` of the one before the step, the rest of the one after.
template <class V>
V mean(const V& before, const V& after, typename V::Scalar old_share) {
  using T = typename V::Scalar;
  return old_share == T(0) ? after : V(old_share * before + (T(1) - old_share) * after);
}

/// m/s²; zero of a set without.
template <class Set>
Vec3 gravity_of(const Set& set) {
  if constexpr (requires { set.gravity; }) return set.gravity;
  else return zero<Vec3>();
}

}  // namespace inner
}  // namespace delassus
