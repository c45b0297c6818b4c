/// Detection with bodies of several convex parts.
#pragma once

#include <delassus/collision/collider.hpp>
#include <delassus/collision/inner/join_faces.hpp>
#include <delassus/collision/inner/margins.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/core/archive.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/compound.hpp>

#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// `WithCompounds{NativeCollision{}}` in the place of the backend, or `WithCompounds{WithMeshes{...}}`: each
/// part of a body is a collider of its own to the backend, and its contacts are the body's. Parts of one body
/// do not meet; the material is the body's. `WithFilter` goes around it.
template <class Backend = inner::Absent>
struct WithCompounds {
  using plays = role::Collision;
  static constexpr unsigned layers = inner::layers_of<Backend> | inner::layer::compounds;
  /// Around what is no backend, or in another order; the loop's checks say so.
  static constexpr bool is_hollow = !inner::Detects<Backend, inner::layer::compounds>;

  Backend backend{};  ///< is given bodies and parts alike as convex shapes

  /// What the backend asks: parts of one body pass through each other; of two bodies, they meet where the bodies do.
  template <class Filter>
  struct PartFilter {
    const WithCompounds& compounds;
    const Filter& filter;
    bool lets(std::uint64_t pair) const {
      const auto [a, b] = compounds.bodies_of(pair);
      return a != b && filter.lets(pair_key(a, b));
    }
    bool pushed(std::uint64_t pair) const
      requires inner::KnowsWhoPushed<Filter>
    {
      const auto [a, b] = compounds.bodies_of(pair);
      return filter.pushed(pair_key(a, b));
    }
    /// Parts are asked for none: what their body's contacts push is known of all of them together.
    bool misses(std::uint64_t pair, const Collider& a, const Collider& b, const auto& meets) const
      requires inner::KnowsWhoMisses<Filter>
    {
      return a.key < part_key && b.key < part_key && filter.misses(pair, a, b, meets);
    }
  };

  WithCompounds() = default;
  /// Around this backend.
  explicit WithCompounds(Backend b) : backend(std::move(b)) {}

  /// Keeps a compound; the shape it returns is for bodies of the loop that has this backend, as many as
  /// wanted. A dynamic body takes `mass()` and `inertia()` of the compound.
  Shape add(Compound compound) {
    DELASSUS_EXPECT(compound.part_count() > 0, "this compound has no part; give it some");
    const Vec3 reach = compound.reach();
    compounds_.push_back(std::move(compound));
    return KeptShape{ShapeKind::compound, int(compounds_.size()) - 1, reach};
  }

  /// That a shape of `add` names.
  const Compound& compound(const Shape& shape) const {
    DELASSUS_EXPECT(shape.kind == ShapeKind::compound && std::size_t(shape.number()) < compounds_.size(),
                    "this compound is none of the backend's; take what its add(...) returned");
    return compounds_[std::size_t(shape.number())];
  }

  void check() const { inner::check_if_it_can(backend); }

  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    split(colliders);
    CollisionReport report = backend.detect(parts_, h, contacts, PartFilter<Filter>{*this, filter});
    give_to_bodies(colliders, contacts);
    return report;
  }
  /// Adds to `contacts` the pairs that were left out and meet within h seconds by the velocities at the end of the solve.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter)
    requires inner::DetectsMissed<Backend, PartFilter<Filter>>
  {
    split(colliders);
    backend.detect_missed(parts_, h, contacts, PartFilter<Filter>{*this, filter});
    give_to_bodies(colliders, contacts);
  }

  void memory(auto& archive) {
    if constexpr (!inner::leaves_shapes<std::remove_cvref_t<decltype(archive)>>) archive(compounds_);
    archive(names_, next_name_);
    inner::remember(backend, archive);
  }

 private:
  /// The keys of a body's parts: `first` and those that follow. They stay as long as the body has this
  /// compound.
  struct Names {
    std::uint32_t body;
    Index compound;
    std::uint32_t first;
  };
  struct Owner {
    Index body, part;
    std::uint32_t key, body_key;
  };
  static constexpr std::uint32_t part_key = 0xf0000000u;  ///< beyond the keys of a world's fifteen first sets

  std::pair<std::uint32_t, std::uint32_t> bodies_of(std::uint64_t pair) const {
    return {body_key(std::uint32_t(pair >> 32)), body_key(std::uint32_t(pair))};
  }
  std::uint32_t body_key(std::uint32_t key) const {
    if (key < part_key) return key;
    const auto at = inner::lower_bound(by_key_.data(), by_key_.data() + by_key_.size(), key,
                                     [](const Owner& o, std::uint32_t k) { return o.key < k; });
    return at->body_key;
  }
  /// Contacts of parts become those of their bodies.
  void give_to_bodies(std::span<const Collider> colliders, std::vector<ContactPoint>& contacts) {
    const Index bodies = Index(colliders.size());
    if (Index(parts_.size()) == bodies) return;
    faces_.clear();
    for (ContactPoint& p : contacts) {
      faces_.name(part_of(p.a, bodies), part_of(p.b, bodies));
      if (p.a < bodies && p.b < bodies) continue;
      // The parts' names are in the contact's: two parts of one body meet another in points of equal names.
      p.feature ^= 0x9e3779b9u * (0x10001u * part_of(p.a, bodies) + 7u * part_of(p.b, bodies) + 1u);
      p.a = body_of(p.a, bodies);
      p.b = body_of(p.b, bodies);
      p.pair = pair_key(colliders[p.a].key, colliders[p.b].key);
      if (colliders[p.a].key >= colliders[p.b].key) p.exchange_bodies();
    }
    faces_.join(contacts);
    inner::sort_by_name(contacts);
    inner::part_equal_names(contacts);
  }
  Index body_of(Index place, Index bodies) const {
    return place < bodies ? place : owners_[place - bodies].body;
  }
  std::uint32_t part_of(Index place, Index bodies) const {
    return place < bodies ? 0u : std::uint32_t(owners_[place - bodies].part) + 1u;
  }

  /// The bodies, those of parts without a shape, and behind them their parts.
  void split(std::span<const Collider> colliders) {
    parts_.assign(colliders.begin(), colliders.end());
    owners_.clear();
    for (Index i = 0; i < Index(colliders.size()); ++i) {
      const Collider& body = colliders[i];
      if (body.shape.kind != ShapeKind::compound) continue;
      parts_[i].shape = {};
      const Index number = Index(body.shape.number());
      DELASSUS_EXPECT(number < Index(compounds_.size()),
                      "this compound is none of the backend's; take what its add(...) returned");
      const Compound& compound = compounds_[number];
      const std::uint32_t first = first_name(body.key, number);
      for (Index k = 0; k < compound.part_count(); ++k) {
        Collider part = body;
        part.shape = compound.shape(k);
        part.pose = {body.pose.to_world(compound.pose(k).position),
                     body.pose.rotation * compound.pose(k).rotation};
        part.velocity = body.velocity_at(part.pose.position);
        part.key = first + std::uint32_t(k);
        parts_.push_back(part);
        owners_.push_back({i, k, part.key, body.key});
      }
    }
    by_key_ = owners_;
    inner::sort(by_key_, [](const Owner& a, const Owner& b) { return a.key < b.key; });
  }

  std::uint32_t first_name(std::uint32_t body, Index compound) {
    auto at = inner::lower_bound(names_.data(), names_.data() + names_.size(), body,
                               [](const Names& n, std::uint32_t key) { return n.body < key; });
    if (at == names_.end() || at->body != body) at = names_.insert(at, {body, -1, 0});
    if (at->compound != compound) {
      *at = {body, compound, part_key + next_name_};
      next_name_ += std::uint32_t(compounds_[compound].part_count());
    }
    return at->first;
  }

  std::vector<Compound> compounds_;
  Array<Names> names_;
  std::uint32_t next_name_ = 0;
  std::vector<Collider> parts_;
  Array<Owner> owners_, by_key_;
  inner::JoinedFaces faces_;
};

}  // namespace delassus
