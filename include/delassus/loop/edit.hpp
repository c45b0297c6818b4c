/// Edits that touch bodies and constraints together.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/type_text.hpp>
#include <delassus/rows/body_set.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/step/drop_constraints.hpp>

#include <string>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// f(set, number of the set) for the set a handle belongs to; refuses one that is stale or of another world.
template <class World, class Set, class F>
void visit_body(World& world, Handle<Set> body, F&& f) {
  bool is_found = false;
  world.each([&](auto& set, auto s) {
    if constexpr (std::is_same_v<typename std::remove_reference_t<decltype(set)>::Handle, Handle<Set>>)
      if (set.contains(body)) {
        is_found = true;
        f(set, Index(s));
      }
  });
  DELASSUS_EXPECT(is_found, wrong_handle(body.owner, "body",
                                         "the handle of body " + text(body.index) + " is stale or of another world"));
}

/// Ends of one body do not move against each other. Two points in elements do, unless they are one.
inline bool are_on_one_body(const Anchor& a, const Anchor& b) {
  if (a.set != b.set || a.block != b.block || a.element != b.element) return false;
  return a.element < 0 || a.local == b.local;
}

/// A joint between one body and itself, or between the world and the world. Templates, so that a program can compile them once.
template <class Char>
[[noreturn]] void refuse_one_body(const std::basic_string<Char>& law, const std::basic_string<Char>& body) {
  refuse(law + ": both ends are on " + body + "; it would hold nothing, let one be on another body or a world_anchor");
}
template <class Char>
[[noreturn]] void refuse_no_body(const std::basic_string<Char>& law) {
  refuse(law + ": both ends are in the world; one must be on a body");
}

/// A joint between bodies that nothing moves.
template <class Char>
[[noreturn]] void refuse_still_ends(const std::basic_string<Char>& law, const std::basic_string<Char>& ends) {
  refuse(law + ": " + ends + " never move, being fixed or the world; it would hold nothing, let one end be on a body that moves");
}
/// A constraint that a listener adds.
template <class Char>
[[noreturn]] void refuse_during_step(const std::basic_string<Char>& law) {
  refuse(law + ": it is added while a step runs, whose arrays have no place for it; add it after the step");
}

template <class World>
std::string name_of_body(const World& world, const Anchor& end) {
  std::string name;
  world.visit(end.set, [&](const auto& set, auto) { name = set.who(end.block); });
  return name;
}

/// Whether nothing moves what is at this end, now or later.
template <class World>
bool never_moves(const World& world, const Anchor& end) {
  bool is_still = true;
  world.visit(end.set, [&](const auto& set, auto) {
    if constexpr (requires { set.never_moves(end.block); }) is_still = set.never_moves(end.block);
    else is_still = false;
  });
  return is_still;
}
/// Whether nothing moves the bodies that a joint holds, now or later.
template <class World, class Item>
bool none_moves(const World& world, Item& item) {
  bool is_still = true;
  each_end(item, [&](const Anchor& end) { is_still = is_still && never_moves(world, end); });
  return is_still;
}
template <class World>
std::string name_of_end(const World& world, const Anchor* end) {
  return end->is_world() ? std::string("the world") : name_of_body(world, *end);
}
/// Of a law whose item nothing moves: its first two ends are "rigid body #0 and the world".
template <class World, class Item>
[[noreturn]] void refuse_still_item(const std::string& law, const World& world, const Item& item) {
  const Anchor *first = nullptr, *second = nullptr;
  each_pair(item, [&](const Anchor& a, const Anchor& b) {
    if (!first) first = &a, second = &b;
  });
  refuse_still_ends(law, first ? name_of_end(world, first) + " and " + name_of_end(world, second) : std::string());
}

/// Adds a constraint to the pool of its law; see `AnimationLoop::add`.
template <bool is_sound, class World, class Laws, class Item>
auto add_constraint(World& world, Laws& laws, bool is_under_way, Item& item) {
  using Law = typename Laws::template law_of<Item>::type;
  static_assert(!std::is_void_v<Law>,
                "delassus: this AnimationLoop stores no constraints of this type; list its law in Constraints{...}");
  static_assert(std::is_void_v<Law> || HasEnds<Item>,
                "delassus: the Item of a law that is added to a loop needs two ends, `Anchor a, b`; one in the world is "
                "world_anchor({0, 0, 0})");
  if constexpr (!std::is_void_v<Law>) {
    if (is_under_way) refuse_during_step(type_text<Law>());
    if constexpr (is_sound) who_refines<refine::check>(laws.template of<Law>().law).check(item);
    if constexpr (HasEnds<Item>) {
      constexpr const char* names[]{"constraint, first end", "constraint, second end", "constraint, first end's carrier",
                                    "constraint, second end's carrier"};
      int k = 0;
      each_end(item, [&](Anchor& end) { world.resolve(end, names[HasParts<Item> ? k++ & 1 : k++]); });
      each_pair(item, [&](const Anchor& a, const Anchor& b) {
        if (a.is_world() && b.is_world()) refuse_no_body(type_text<Law>());
      });
      if (none_moves(world, item)) refuse_still_item(type_text<Law>(), world, item);
      each_pair(item, [&](const Anchor& a, const Anchor& b) {
        if (!a.is_world() && are_on_one_body(a, b)) refuse_one_body(type_text<Law>(), name_of_body(world, a));
      });
    }
    return laws.template of<Law>().add(item);
  }
}

/// Items that were read speak of the sets of this world.
template <class World, class Pool>
void adopt(const World& world, Pool& pool) {
  for (auto& item : pool.items)
    each_end(item, [&](Anchor& end) {
      world.visit(end.set, [&](const auto& set, auto) { end.owner = set.owner(); });
    });
}

/// Takes a body out, with every constraint that holds it.
template <class World, class Laws, class Set>
void remove_body(World& world, Laws& laws, Handle<Set> body) {
  bool is_found = false;
  world.each([&](auto& set, auto) {
    if constexpr (requires { set.remove(body); })
      if (set.owner() == body.owner) {
        is_found = true;
        set.remove(body);
        // Where a body is more than its block, joints are found by the ends that have become stale.
        if constexpr (!std::is_same_v<typename std::remove_reference_t<decltype(set)>::Handle, Handle<Set>>)
          drop_stale<typename World::Scalar>(ViewOf<World>(world), PoolsOf<Laws, typename World::Scalar>(laws).all());
        each_pool(laws, [&](auto, auto& pool) {
          if constexpr (requires { pool.remove_on(body.owner, body.index); }) pool.remove_on(body.owner, body.index);
        });
      }
  });
  DELASSUS_EXPECT(is_found, "remove: " + wrong_handle(body.owner, "body", "this handle belongs to another world"));
}

}  // namespace delassus::inner
