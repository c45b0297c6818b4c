/// The bodies of a simulation: a tuple of body sets.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/math/fits.hpp>
#include <delassus/rows/body_set.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

/// A second set of one type: `Tagged<RigidBodies, struct Debris>`.
template <class Set, class Tag>
struct Tagged : Set {
  using Set::Set;
};

namespace inner {

/// The scalar of the first set; a World without one, or of something else, is refused by its loop.
template <class... Sets>
struct scalar_of {
  using type = double;
};
template <class First, class... Rest>
  requires requires { typename First::Scalar; }
struct scalar_of<First, Rest...> {
  using type = typename First::Scalar;
};

/// In place of a set that is not there: the sentence has been said.
template <class Set>
Set& no_set();

}  // namespace inner

/// A tuple of body sets of one scalar. Laws and collision see the sets only through `visit`, `point` and `frame`.
template <class... Sets>
class World {
 public:
  using plays = role::World;
  static constexpr int set_count = int(sizeof...(Sets));  ///< how many types `Sets` names
  /// Velocities of a block of set s; 0 for the world, s < 0.
  template <int s>
  static constexpr int width_of =
      s < 0 ? 0 : std::array<int, std::size_t(set_count) + 1>{Sets::width..., 0}[s < 0 ? 0 : s];
  /// One F<Set> for every set.
  template <template <class> class F>
  using PerSet = std::tuple<F<Sets>...>;
  using Scalar = typename inner::scalar_of<Sets...>::type;

  World()
    requires(set_count > 0)
  = default;
  /// Takes the sets over, in their order.
  explicit World(Sets... sets) : sets_{{static_cast<Sets&&>(sets)}...} {}
  World(World&&) = default;  ///< handles stay valid
  World& operator=(World&&) = default;
  /// A copy that is not meant: bodies of it would be moved, and the loop's own would not.
  template <std::same_as<World> Copied>
  World(Copied& world) : World(std::as_const(world)) {
    static_assert(!std::is_same_v<Copied, World>,
                  "delassus: a World is not copied silently; write `auto& world` for the one of a loop, std::move(world) to hand "
                  "one over, or world.clone() for a copy that is meant");
  }
  /// A copy with all its bodies. The handles of each are good for both.
  World clone() const { return World(*this); }

  /// Number s of the list of types, from 0.
  template <int s>
  auto& set() {
    return inner::part<s>(sets_);
  }
  /// The same, to read.
  template <int s>
  const auto& set() const {
    return inner::part<s>(sets_);
  }
  /// The only set of this type; with none, or with two, it does not compile.
  template <class Set>
  Set& get() {
    return the<Set>(sets_);
  }
  /// The same, to read.
  template <class Set>
  const Set& get() const {
    return the<Set>(sets_);
  }

  /// f(set, std::integral_constant<int, s>) for every set, in order.
  template <class F>
  [[gnu::always_inline]] void each(F&& f) {
    each_of(*this, f, std::make_integer_sequence<int, set_count>{});
  }
  /// The same, to read.
  template <class F>
  [[gnu::always_inline]] void each(F&& f) const {
    each_of(*this, f, std::make_integer_sequence<int, set_count>{});
  }

  /// f(set, std::integral_constant<int, s>) for set number `s`; nothing for the world (s < 0).
  template <class F>
  [[gnu::always_inline]] void visit(int s, F&& f) const {
    visit_one(s, f, std::make_integer_sequence<int, set_count>{});
  }

  /// Where an anchor is in the world now, m. It may be one that no loop has seen, fresh from `anchor(set, body)`; those of
  /// removed bodies and of other worlds are refused then.
  Vec3 point(const Anchor& a) const {
    Vec3 x = a.local;
    bool is_known = a.owner == 0;
    visit(a.set, [&](const auto& set, auto) { x = set.point(a), is_known = true; });
    if (!is_known) [[unlikely]] return point_of_new(a);
    return x;
  }

  /// How the frame of an anchor is turned in the world now; a particle has none and says its anchor's own.
  Quat frame(const Anchor& a) const {
    Quat q = a.frame;
    bool is_known = a.owner == 0;
    visit(a.set, [&](const auto& set, auto) {
      if constexpr (requires { set.frame(a); }) q = set.frame(a);
      is_known = true;
    });
    if (!is_known) [[unlikely]] return frame_of_new(a);
    return q;
  }

  /// The same as a matrix: its axes are the columns. Between the ends of a step of the midpoint rule it is no rotation.
  Mat3 axes(const Anchor& a) const {
    Mat3 R;
    bool is_found = false;
    visit(a.set, [&](const auto& set, auto) {
      if constexpr (requires { set.axes(a); }) R = set.axes(a), is_found = true;
    });
    return is_found ? R : Mat3(frame(a).toRotationMatrix());
  }

  /// Whether the body behind an anchor is still there; the world always is.
  bool is_current(const Anchor& a) const {
    bool is_there = true;
    visit(a.set, [&](const auto& set, auto) {
      is_there = set.is_alive(a.block) && set.handle(a.block).generation == a.generation;
    });
    return is_there;
  }

  /// Finds the set an anchor speaks of; refuses one of another world or of a removed body.
  void resolve(Anchor& a, const char* what) const {
    if (a.owner == 0) {
      DELASSUS_EXPECT(is_finite(a.local) && is_finite(a.frame.coeffs()),
                      std::string(what) + ": the world anchor's point or frame is not finite");
      DELASSUS_EXPECT(inner::fits<Scalar>(a.local),
                      std::string(what) + ": the world anchor's point " + inner::beyond<Scalar>(a.local, "m"));
      a.set = -1;
      return;
    }
    bool is_found = false;
    each([&](const auto& set, auto s) {
      if (set.owner() != a.owner) return;
      is_found = true;
      a.set = s;
      using Handle = std::remove_cvref_t<decltype(set.handle(0))>;
      DELASSUS_EXPECT(set.contains(Handle{a.block, a.generation, a.owner}),
                      std::string(what) + ": " + set.who(a.block) + " was removed; its anchor is stale");
    });
    DELASSUS_EXPECT(is_found, std::string(what) + ": the anchor belongs to a body of another world");
  }

  void memory(auto& archive) { archive(sets_); }

 private:
  template <std::size_t, class>
  friend struct inner::PackPart;  // a loop clones its policies
  World(const World&) = default;
  World& operator=(const World&) = default;

  template <class Set>
  static consteval bool has_one() {
    constexpr int count = (int(std::is_same_v<Set, Sets>) + ... + 0);
    static_assert(count > 0, "delassus: this World has no set of bodies of this type; add it to World{...}");
    static_assert(count < 2,
                  "delassus: this World has two sets of this type; make the second one Tagged<RigidBodies, struct "
                  "Debris>, and ask for it by that name");
    return count == 1;
  }
  template <class Set>
  static auto& the(auto& sets) {
    if constexpr (has_one<Set>())
      return inner::part_of_type<Set>(sets);
    else
      return inner::no_set<Set>();
  }
  /// Of an anchor that no loop has seen: the number of its set is found first.
  [[gnu::cold, gnu::noinline]] Vec3 point_of_new(Anchor a) const {
    resolve(a, "point");
    return point(a);
  }
  [[gnu::cold, gnu::noinline]] Quat frame_of_new(Anchor a) const {
    resolve(a, "frame");
    return frame(a);
  }
  template <class Self, class F, int... s>
  [[gnu::always_inline]] static void each_of(Self& self, F& f, std::integer_sequence<int, s...>) {
    (f(inner::part<s>(self.sets_), std::integral_constant<int, s>{}), ...);
  }

  template <class F, int... k>
  [[gnu::always_inline]] void visit_one(int s, F& f, std::integer_sequence<int, k...>) const {
    ((k == s ? void(f(inner::part<k>(sets_), std::integral_constant<int, k>{})) : void()), ...);
  }

  inner::Pack<Sets...> sets_;
};

/// One velocity for every block of a set.
template <class Set>
using VelocitiesOf = Array<typename Set::Velocity>;

/// The set of type S of a world.
template <class S, class... Sets>
S& bodies(World<Sets...>& world) {
  return world.template get<S>();
}
/// The same, to read.
template <class S, class... Sets>
const S& bodies(const World<Sets...>& world) {
  return world.template get<S>();
}

/// double or float: that of all its sets.
template <class World>
using scalar_t = typename World::Scalar;

/// The material point `local` (body frame, m) of a body, with a joint frame turned by `frame` against the body's.
template <BodySet S>
Anchor anchor(const S& set, typename S::Handle body, const Vec3& local = zero<Vec3>(),
              const Quat& frame = Quat::Identity()) {
  DELASSUS_EXPECT(set.contains(body),
                  "anchor: " + inner::wrong_handle(body.owner, "body",
                                                   "the handle of " + set.who(body.index) + " is stale or of another world"));
  DELASSUS_EXPECT(is_finite(local), "anchor: the point on " + set.who(body.index) + " is not finite");
  DELASSUS_EXPECT(inner::fits<typename S::Scalar>(local), "anchor: the point on " + set.who(body.index) + ", " +
                                                              inner::beyond<typename S::Scalar>(local, "m"));
  DELASSUS_EXPECT(std::abs(norm(frame.coeffs()) - 1) < 1e-6,
                  "anchor: the frame on " + set.who(body.index) + " is not a unit quaternion");
  return {.block = body.index,
          .local = local,
          .frame = frame,
          .has_frame = FramedSet<S>,
          .generation = body.generation,
          .owner = body.owner};
}

}  // namespace delassus
