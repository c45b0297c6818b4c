/// What outlives a step of a loop, written down and put into another: all that knows the insides of a loop.
#pragma once

#include <delassus/activity/hand_picked.hpp>
#include <delassus/activity/inner/dormant.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/constraints/bounces.hpp>
#include <delassus/integrators/inner/midpoint_stages.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "text.hpp"

// The state, in the order in which `AnimationLoop::memory` names it. All of it is in the way of that archive,
// so that this file needs no private member; who changes an array of the loop changes the part below that
// writes it, and keeps the words, so that data of before can still be read.
//
//   bodies    of each set: x, q, v of all that are not fixed, and whether they are awake
//   time      h, h of the last step, start, steps: the warm start is scaled with h/h_last
//   bounces   of restitution: rows of the last step that may bounce, velocities of the last two; may be absent where e = 0
//   past      of GeneralizedAlpha, Newmark and Bdf2: two accelerations a point, and x and v as the last step
//   left them shared    of JointByJoint: whether joints share bodies joints    of each law: by place whether
//   there is one (2: asleep), its impulse, whether that is no start, its angle or
//             way, which counts turns; who broke
//   contacts  by pair and feature: where it was, its impulse, as vectors of the world
//   asleep    bodies and joints that sleep or are switched off, by group; how long the others are quiet; what
//   they lie on names     keys of the parts of compounds pairs     what collision detection keeps of a pair:
//   normal, points and their ids, the patch of a pair at rest
//
// What the host gives before each step (loads, targets of kinematic bodies) is no part of it: the program
// gives it again. Shapes, masses, materials, meshes, items of joints and numbers of policies are the scene's.
// What no text holds: the factors that LazyCompliance and PrecomputedCompliance keep; a combination with them
// says so.

namespace delassus {
class Compound;
class HeightField;
class TriangleMesh;
}  // namespace delassus

namespace trace {

using namespace delassus;

/// FNV-1a, 64 bits. Source: docs/references.md, [FowlerNollVo].
struct Hash {
  std::uint64_t value = 14695981039346656037ull;

  void bytes(const void* from, std::size_t count) {
    const auto* p = static_cast<const unsigned char*>(from);
    for (std::size_t i = 0; i < count; ++i) value = (value ^ p[i]) * 1099511628211ull;
  }
  void matrix(const auto& m) { bytes(m.data(), sizeof(m.data()[0]) * std::size_t(m.size())); }
};

/// Takes hold of the poses inside a set that shows none.
template <class T>
struct Poses {
  static constexpr bool reads = false;
  inner::RigidState<T>* found = nullptr;

  template <class... X>
  void operator()(X&... x) {
    (take(x), ...);
  }
  void take(inner::RigidState<T>& state) { found = &state; }
  void take(auto&) {}
};

/// The archive for `loop.memory(archive)`. `pairs` may be absent when it is read: collision then starts anew.
class Memory {
 public:
  static constexpr bool reads = false;  // owners and tables stay those of the loop that is there

  Memory(Text& state, Text& pairs) : text_(state), pairs_(pairs) {}

  template <class... X>
  void operator()(X&... x) {
    (part(x), ...);
  }

 private:
  // --- bodies
  // ------------------------------------------------------------------------------------------------------
  template <class... Sets>
  void part(World<Sets...>& world) {
    world.each([&](auto& set, auto) {
      text_.line("bodies");
      std::vector<Index> written;
      for (Index b = 0; b < set.blocks(); ++b)
        if (set.is_alive(b) && !is_fixed(set, b)) written.push_back(b);
      text_.size(written);
      for (Index b : written) {
        text_.line("body"), text_(b);
        body(set, b);
      }
      if constexpr (requires { set.loads(); })
        if (text_.reads())
          for (auto& load : set.loads()) load.setZero();
    });
    text_.line("time");
  }
  template <class Set>
  static bool is_fixed(const Set& set, Index b) {
    if constexpr (requires { set.motion(b); })
      return set.motion(b) == Motion::fixed;
    else
      return set.is_awake(b) && !set.moves(b);
  }
  template <class Set>
  void body(Set& set, Index b) {
    bool is_awake = set.is_awake(b);
    text_(is_awake);
    if constexpr (Set::width == 6) {
      auto& state = poses(set);
      part(state.x[b]), part(state.q[b].coeffs());
      if (text_.reads()) state.turn(b);
    } else {
      Vec3 x = set.pose(b).position;
      part(x);
      if (text_.reads()) set.place(set.handle(b), x);
    }
    part(set.velocity()[b]);
    if (!text_.reads() || is_awake == set.is_awake(b)) return;
    if (is_awake)
      set.wake(b);
    else
      set.put_to_sleep(b);
  }
  template <class Set>
  static auto& poses(Set& set) {
    if constexpr (requires { set.state(); }) {
      return set.state();
    } else {
      Poses<typename Set::Scalar> inside;
      set.memory(inside);
      return *inside.found;
    }
  }

  // --- joints
  // ------------------------------------------------------------------------------------------------------
  template <class Law>
  void part(Pool<Law>& pool) {
    text_.line("joints");
    std::uint64_t places = pool.impulse.size();
    text_(places);
    for (Index k = 0; k < Index(places); ++k) {
      int presence = !pool.slots.is_alive(k) ? 0 : pool.slots.is_awake(k) ? 1 : 2;
      text_(presence), part(pool.impulse[k]), text_(pool.starts_cold[k]);
      axis(pool.items[k]);
      if (!text_.reads()) continue;
      if (presence == 0 && pool.slots.is_alive(k)) pool.slots.release(k);
      if (presence > 0) pool.slots.set_awake(k, presence == 1);
    }
    if constexpr (refines<Law>(refine::breaks)) {
      text_.size(pool.broken);
      for (auto& joint : pool.broken) {
        text_(joint.index);
        if (text_.reads()) joint = pool.handle(joint.index);
      }
    }
  }

  /// What a law on a free axis follows from step to step.
  template <class Item>
  void axis(Item& item) {
    if constexpr (requires { item.position; }) text_(item.position);
    if constexpr (requires { item.way; }) text_(item.way);
    if constexpr (requires { item.position_a; }) text_(item.position_a), text_(item.position_b);
    if constexpr (requires { item.phase; }) text_(item.phase);
  }

  // --- contacts
  // ----------------------------------------------------------------------------------------------------
  template <std::derived_from<ContactCache> Cache>
  void part(Cache& book) {
    text_.line("contacts");
    book.memory(*this);
  }
  void part(ContactMemory::Entry& e) {
    text_.line("contact"), text_(e.pair), text_(e.feature), part(e.point), part(e.impulse);
    if (text_.reads()) e.is_taken = false;
  }
  template <std::derived_from<Materials> M>
  void part(M&) {}

  template <class T>
  void part(Bounces<T>& bounces) {
    if (text_.reads() && !text_.is_next("bounces")) return;
    text_.line("bounces");
    (*this)(bounces.pasts, bounces.velocities[0], bounces.velocities[1]);  // of bodies that were never removed
  }
  void part(RowPast& r) {
    text_.line("bounce"), text_(r.item), text_(r.generations), text_(r.feature), text_(r.row), text_(r.acceleration), text_(r.parts),
        text_(r.impulse);
  }

  // --- what sleeps
  // -------------------------------------------------------------------------------------------------
  template <class World, class Laws>
  void part(Dormant<World, Laws>& dormant) {
    text_.line("asleep");
    dormant.memory(*this);
  }
  template <class Body>
  requires requires(Body b) { b.set, b.block, b.pose, b.box; }
  void part(Body& b) {
    text_(b.set), text_(b.block), text_(b.generation), part(b.pose.position), part(b.pose.rotation);
    if constexpr (requires { b.group; }) text_(b.group);
    part(b.box.min()), part(b.box.max());
  }
  /// No trace has sleepers on joints of bodies that are led.
  template <class Hold>
  requires(requires(Hold h) { h.group, h.pose; } && !requires(Hold h) { h.box; })
  void part(std::vector<Hold>&) {}
  template <class Item>
  requires requires(Item i) { i.pool, i.place, i.group; }
  void part(Item& i) { text_(i.pool), text_(i.place), text_(i.group), text_(i.generation); }

  // --- collision
  // ---------------------------------------------------------------------------------------------------
  void part(inner::PairSlots& slots) {
    Array<inner::RestingPair> pairs;
    slots.copy_to(pairs);
    each_pair(pairs);
    if (pairs_.reads()) slots.take_from(pairs);
  }
  void part(Array<PairMemory>& pairs) { each_pair(pairs); }
  void part(Array<PairImpact>& impacts) {
    if (pairs_.reads() ? !pairs_.is_next("impacts") : impacts.empty()) return;
    Memory to(pairs_, pairs_);
    pairs_.line("impacts"), pairs_.size(impacts);
    for (PairImpact& i : impacts) to.text_(i.pair), to.part(i.impact);
  }
  void part(RememberedImpact& i) { part(i.normal), part(i.arm_a), part(i.arm_b), text_(i.id), text_(i.is_there); }
  template <class Pair>
  void each_pair(Array<Pair>& pairs) {
    if (pairs_.reads() && pairs_.is_at_end()) return;
    Memory to(pairs_, pairs_);
    pairs_.line("pairs"), pairs_.size(pairs);
    for (Pair& p : pairs) to.pair(p);
  }
  void pair(PairMemory& p) {
    int owner = int(p.owner) + (p.impact.is_there ? 4 : 0);
    text_.line("pair"), text_(p.pair), part(p.normal), text_(owner), text_(p.count);
    p.owner = inner::NormalOwner(owner & 3);
    if (owner & 4) part(p.impact);
    for (int k = 0; k < p.count; ++k)
      text_(p.point[k].name), text_(p.point[k].id), part(p.point[k].local_a), part(p.point[k].local_b);
  }
  void pair(inner::RestingPair& p) {
    pair(static_cast<PairMemory&>(p));
    text_(p.margin);
    if (p.margin < 0) return;
    text_(p.shapes), part(p.normal_a), part(p.normal_b);
    text_(p.area.size), part(p.area.middle), text_(p.area.mean_distance);
    for (int k = 0; k < p.count; ++k) text_(p.gap[k]), text_(p.by_id[k]);
  }
  /// Meshes and filters are the scene's.
  void part(std::vector<TriangleMesh>&) {}
  void part(std::vector<HeightField>&) {}
  void part(std::vector<Compound>&) {}
  template <class Kind>
  requires requires(Kind k) { k.is_field; }
  void part(Array<Kind>&) {}
  template <class Ignored>
  requires requires(Ignored p) { p.a.block, p.b.block; }
  void part(Array<Ignored>&) {}
  template <class Names>
  requires requires(Names n) { n.body, n.compound, n.first; }
  void part(Names& n) { text_(n.body), text_(n.compound), text_(n.first); }

  // --- integrators, solvers
  // ----------------------------------------------------------------------------------------
  template <class Past>
  requires requires(Past p) { p.first, p.second, p.first.data(); }
  void part(Past& p) { part(p.first), part(p.second); }

  /// No trace has joints on bodies that are led.
  template <class Set>
  void part(inner::LedMotion<Set>&) {}

  // --- numbers and lists
  // -------------------------------------------------------------------------------------------
  template <class X>
  requires std::is_arithmetic_v<X>
  void part(X& x) { text_(x); }
  template <class D>
  void part(Eigen::MatrixBase<D>& m) {
    for (Index k = 0; k < Index(m.size()); ++k) text_(m.derived().data()[k]);
  }
  template <class E>
  void part(Array<E>& list) {
    text_.size(list);
    for (E& e : list) part(e);
  }
  template <class E>
  void part(OwningArray<E>& list) {
    text_.size(list);
    for (E& e : list) part(e);
  }
  template <class E>
  void part(std::vector<E>& list) {
    text_.size(list);
    for (E& e : list) part(e);
  }
  template <class E, std::size_t n>
  void part(std::array<E, n>& list) {
    for (E& e : list) part(e);
  }
  template <class X>
  requires(requires(X& x, Memory& m) { x.memory(m); } && !std::derived_from<X, Materials> && !std::derived_from<X, ContactCache>)
  void part(X& x) { x.memory(*this); }

  Text &text_, &pairs_;
};

/// Writes the state of a loop, or puts it into a fresh one of the same scene. The rows of the last step are
/// forgotten.
template <class Loop>
void walk_state(Loop& loop, Text& state, Text& pairs) {
  Memory memory(state, pairs);
  loop.memory(memory);
  if constexpr (requires { loop.dormant(); })
    if constexpr (Loop::template has<HandPicked>)
      if (state.reads())
        for (const auto& body : loop.dormant().bodies())
          loop.world().each([&](auto& set, auto s) {
            if (s == body.set) set.set_fixed(body.block, true);
          });
}

/// f(matrix) for q and v of all bodies, and the impulses of all joints and contacts.
template <class Loop, class F>
void each_result(const Loop& loop, const F& f) {
  loop.world().each([&](const auto& set, auto) {
    for (Index b = 0; b < set.blocks(); ++b) {
      if (!set.is_alive(b)) continue;
      const Pose pose = set.pose(b);
      f(pose.position), f(pose.rotation), f(set.velocity()[b]);
    }
  });
  each_impulse(loop, f);
}
/// f(point) for the material point (1, 2, 3) m of every body that moves: where it is and how it is turned, in
/// three numbers.
template <class Loop, class F>
void each_place(const Loop& loop, const F& f) {
  loop.world().each([&](const auto& set, auto) {
    for (Index b = 0; b < set.blocks(); ++b)
      if (set.is_alive(b) && set.moves(b)) f(set.pose(b).to_world(Vec3(1, 2, 3)));
  });
}
template <class Loop, class F>
void each_velocity(const Loop& loop, const F& f) {
  loop.world().each([&](const auto& set, auto) {
    for (Index b = 0; b < set.blocks(); ++b)
      if (set.is_alive(b) && set.moves(b)) f(set.velocity()[b]);
  });
}
template <class Loop, class F>
void each_impulse(const Loop& loop, const F& f) {
  loop.each_impulse(f);
  if constexpr (Loop::Laws::has_contacts)
    for (const ContactResult& c : loop.contacts()) f(c.impulse);
}

// --- problems without a loop
// -------------------------------------------------------------------------------------------

/// f(d, λ) for the rows of each item of a problem, whether in an island or not.
template <class Problem, class F>
void each_item(Problem& problem, const F& f) {
  for_each_index<Problem::Rows::pool_count>([&](auto p) {
    auto& pool = problem.rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i) f(pool.d[i], pool.lambda[i]);
  });
}
/// f(u) for them, u = W λ + d.
template <class Problem, class F>
void each_row_velocity(const Problem& problem, const F& f) {
  for_each_index<Problem::Rows::pool_count>([&](auto p) {
    const auto& pool = problem.rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i) f(problem.W.template residual<p>(problem.rows, i));
  });
}

}  // namespace trace
