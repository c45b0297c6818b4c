/// Detection with the surfaces of deformable bodies: what touches them between their nodes, and they each
/// other.
#pragma once

#include <delassus/collision/inner/soft_pairs.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/sort.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace delassus {

/// `WithSurfaces{NativeCollision{}}` in the place of the backend, or `WithSurfaces{WithMeshes{...}}`:
/// deformable bodies with a `contact_radius` have a surface that thick. Their nodes are spheres to the
/// backend as ever; here their triangles and edges meet convex shapes, meshes, the surfaces of other such
/// bodies, and, where `self_contact`, their own but for neighbours. A contact between nodes acts on the nodes
/// around it, by their shares. Compounds meet nodes alone. `WithFilter` goes around it.
template <class Backend = inner::Absent>
struct WithSurfaces {
  using plays = role::Collision;
  static constexpr unsigned layers = inner::layers_of<Backend> | inner::layer::surfaces;
  /// Around what is no backend, or in another order; the loop's checks say so.
  static constexpr bool is_hollow = !inner::Detects<Backend, inner::layer::surfaces>;

  Backend backend{};  ///< meets nodes as spheres
  bool self_contact = true;  ///< one body's triangles and edges meet each other

  /// What the backend asks: nodes of surfaces do not meet nodes; their triangles do.
  template <class Filter>
  struct NodeFilter {
    const WithSurfaces& surfaces;
    const Filter& filter;
    bool lets(std::uint64_t pair) const {
      return filter.lets(pair) &&
             (surfaces.owner_of(std::uint32_t(pair >> 32)) < 0 || surfaces.owner_of(std::uint32_t(pair)) < 0);
    }
    bool pushed(std::uint64_t pair) const
      requires inner::KnowsWhoPushed<Filter>
    {
      return filter.pushed(pair);
    }
    bool misses(std::uint64_t pair, const Collider& a, const Collider& b, const auto& meets) const
      requires inner::KnowsWhoMisses<Filter>
    {
      return filter.misses(pair, a, b, meets);
    }
  };

  WithSurfaces() = default;
  /// Around this backend; `meets_itself` becomes `self_contact`.
  explicit WithSurfaces(Backend b, bool meets_itself = true)
      : backend(std::move(b)), self_contact(meets_itself) {}

  void check() const { inner::check_if_it_can(backend); }

  /// The loop shows its world before each detection: bodies come and go, nodes have moved.
  template <class World>
  void see(const World& world) {
    next_.clear();
    world.each([&](const auto& set, auto s) {
      if constexpr (requires { set.each_mesh([](Index, std::uint32_t, const auto&) {}); })
        set.each_mesh([&](Index k, std::uint32_t number, const auto& body) {
          if (!has_thickness(set, body)) return;
          const auto same = [&](const inner::SoftSurface& x) { return x.is_of(s, k, number); };
          const auto known = std::find_if(surfaces_.begin(), surfaces_.end(), same);
          if (known != surfaces_.end())
            next_.push_back(std::move(*known)), surfaces_.erase(known);
          else
            next_.emplace_back(Index(s), k, number, body.mesh(), body.blocks());
          next_.back().follow(set);
        });
    });
    surfaces_.swap(next_);
  }

  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    find_owners(colliders);
    CollisionReport report = backend.detect(colliders, h, contacts, NodeFilter<Filter>{*this, filter});
    ends_.clear();
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      if (!is_present(i)) continue;
      const Pairing<Filter> pairing{*this, filter, colliders, h, contacts};
      for (Index other = 0; other < Index(colliders.size()); ++other)
        report.queries += pairing.rigid(i, other);
      for (std::size_t j = i; j < surfaces_.size(); ++j)
        if (is_present(j) && (i != j || self_contact)) report.queries += pairing.soft(i, j);
    }
    if (!ends_.empty()) inner::sort_by_name(contacts);
    inner::sort(ends_);
    report.points = Index(contacts.size());
    return report;
  }

  /// Of nodes and bodies; a surface meets what is within its margin.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter)
    requires inner::DetectsMissed<Backend, NodeFilter<Filter>>
  {
    backend.detect_missed(colliders, h, contacts, NodeFilter<Filter>{*this, filter});
  }

  /// Puts the ends of contacts between nodes where they are: `results` in the order of the contacts, some of
  /// which may be gone.
  template <class Results>
  void place_ends(Results& results) const {
    auto end = ends_.begin();
    for (auto& r : results) {
      const Ends here{r.record.pair, r.record.feature, {}, {}};
      while (end != ends_.end() && *end < here) ++end;
      if (end == ends_.end()) return;
      if (here < *end) continue;
      if (end->a.set >= 0) r.record.a = end->a;
      if (end->b.set >= 0) r.record.b = end->b;
    }
  }

  void memory(auto& archive) {
    if (archive.reads) surfaces_.clear();
    inner::remember(backend, archive);
  }

 private:
  /// A contact by name, and where its ends are; one without a set stays at its body.
  struct Ends {
    std::uint64_t pair;
    std::uint32_t feature;
    Anchor a, b;
    bool operator<(const Ends& o) const { return pair != o.pair ? pair < o.pair : feature < o.feature; }
  };
  /// Whose node a collider is.
  struct Owner {
    std::uint32_t key;
    Index surface;
  };

  template <class Filter>
  struct Pairing;

  template <class Set, class Body>
  static bool has_thickness(const Set& set, const Body& body) {
    for (const Index b : body.blocks())
      if (set.has_collider(b)) return true;
    return false;
  }

  Index owner_of(std::uint32_t key) const {
    const auto at = inner::lower_bound(owners_.data(), owners_.data() + owners_.size(), key,
                                     [](const Owner& o, std::uint32_t k) { return o.key < k; });
    return at != owners_.end() && at->key == key ? at->surface : Index(-1);
  }

  /// Which colliders are nodes of a surface; the one of its first node stands for the whole.
  void find_owners(std::span<const Collider> colliders) {
    owners_.clear();
    for (Index i = 0; i < Index(surfaces_.size()); ++i)
      for (const Index b : surfaces_[i].blocks()) owners_.push_back({collider_key(surfaces_[i].set(), b), i});
    inner::sort(owners_, [](const Owner& x, const Owner& y) { return x.key < y.key; });
    place_.assign(surfaces_.size(), -1);
    is_node_.assign(colliders.size(), 0);
    for (Index c = 0; c < Index(colliders.size()); ++c) {
      const Index i = owner_of(colliders[c].key);
      if (i < 0) continue;
      is_node_[c] = 1;
      if (colliders[c].key == collider_key(surfaces_[i].set(), surfaces_[i].blocks()[0])) place_[i] = c;
    }
  }
  bool is_present(std::size_t i) const { return place_[i] >= 0 && surfaces_[i].is_sound(); }

  std::vector<inner::SoftSurface> surfaces_, next_;
  Array<Owner> owners_;
  Array<Index> place_;   ///< of each surface among the colliders
  Array<char> is_node_;  ///< of each collider
  Array<Ends> ends_;
  inner::SoftPairs pairs_;
};

/// One detection: pairs of a surface with a collider or a surface, and what becomes of their features.
template <class Backend>
template <class Filter>
struct WithSurfaces<Backend>::Pairing {
  WithSurfaces& all;
  const Filter& filter;
  std::span<const Collider> colliders;
  double h;
  std::vector<ContactPoint>& contacts;

  Index rigid(std::size_t i, Index other) const {
    const inner::SoftSurface& s = all.surfaces_[i];
    const Collider &a = colliders[all.place_[i]], &b = colliders[other];
    const ShapeKind kind = b.shape.kind;
    if (all.is_node_[other] || kind == ShapeKind::none || kind == ShapeKind::half_space ||
        kind == ShapeKind::compound || !may_meet(a, b, s.is_movable(), b.is_movable))
      return 0;
    const double scale = std::min(s.scale(), length_scale(b.shape));
    const double reach = s.radius() + widest(s.top_speed() + inner::top_speed(b), scale);
    if (!inner::bounds_around(b.shape, b.pose, reach).meets(s.bounds())) return 0;
    Index queries = 0;
    if (kind == ShapeKind::mesh)
      with_surface(all.backend, b.shape, [&](const auto& mesh) {
        queries = all.pairs_.cross(s, mesh, b.pose, TouchRange{reach, reach, scale});
      });
    else
      queries = all.pairs_.collide(s, b.shape, b.pose, reach, scale);
    emit(i, -1, other, scale);
    return queries;
  }

  Index soft(std::size_t i, std::size_t j) const {
    const inner::SoftSurface &s = all.surfaces_[i], &o = all.surfaces_[j];
    const Collider &a = colliders[all.place_[i]], &b = colliders[all.place_[j]];
    const bool is_self = i == j;
    if (is_self ? !s.is_movable() : !may_meet(a, b, s.is_movable(), o.is_movable())) return 0;
    const double scale = std::min(s.scale(), o.scale());
    const double speed = is_self ? 2 * s.inner_speed() : s.top_speed() + o.top_speed();
    const double reach = s.radius() + o.radius() + widest(speed, scale);
    const Index queries = all.pairs_.cross(s, o, TouchRange{reach, reach, scale});
    emit(i, Index(j), all.place_[j], scale);
    return queries;
  }

 private:
  static bool may_meet(const Collider& a, const Collider& b, bool a_moves, bool b_moves) {
    return (a_moves || b_moves) && (a.group & b.collides_with) != 0 && (b.group & a.collides_with) != 0;
  }
  double widest(double speed, double scale) const {
    const CollisionSettings settings = inner::settings_of(all);
    return settings.contact_distance + inner::widest_margin(speed, scale, h, settings);
  }

  /// Meshes are kept by some layer of the backend.
  template <class Layer, class F>
  static void with_surface(const Layer& layer, const Shape& shape, const F& f) {
    inner::ask_layer(layer, [&](const auto& own) -> decltype(own.with_surface(shape, f)) { own.with_surface(shape, f); });
  }

  /// Turns features of surface i with surface j, or with the collider at `other` where j < 0, into contacts.
  void emit(std::size_t i, Index j, Index other, double scale) const {
    const inner::SoftSurface& s = all.surfaces_[i];
    const inner::SoftSurface* o = j >= 0 ? &all.surfaces_[j] : nullptr;
    const Collider &a = colliders[all.place_[i]], &b = colliders[other];
    const CollisionSettings settings = inner::settings_of(all);
    all.pairs_.name_apart();
    for (const inner::FeatureContact& c : all.pairs_.found) {
      if (c.point.gap < 0 && is_other_side(s, o, c.point.name)) continue;
      const Vec3 &n = c.normal, x = s.shares(c.triangle_a, c.point.a),
                 y = o ? o->shares(c.triangle_b, c.point.b) : Vec3(zero<Vec3>());
      double of_a = s.radius(), of_b = o ? o->radius() : 0;
      if (o == &s) {
        // No thicker than what was apart at rest; and what seems passed by as much is the body between its
        // sides.
        const double rest = norm(s.rest_point(c.triangle_a, x) - s.rest_point(c.triangle_b, y));
        if (c.point.gap < -0.1 * rest) continue;
        of_a = of_b = std::min(of_a, 0.5 * rest);
      }
      const Vec3 va = s.velocity(c.triangle_a, x),
                 vb = o ? o->velocity(c.triangle_b, y) : b.velocity_at(c.point.b);
      const double gap = c.point.gap - of_a - of_b - settings.contact_distance;
      if (!(gap <= inner::widest_margin(std::abs(dot(n, vb - va)), scale, h, settings))) continue;
      if (!s.moves(c.triangle_a, x) && !(o ? o->moves(c.triangle_b, y) : b.is_movable)) continue;
      if (!lets(s, c.triangle_a, x, b.key) || (o && !lets(*o, c.triangle_b, y, a.key))) continue;
      const Vec3 shift = 0.5 * settings.contact_distance * n;
      ContactPoint p{.a = all.place_[i],
                     .b = other,
                     .point_a = c.point.a + of_a * n + shift,
                     .point_b = c.point.b - of_b * n - shift,
                     .normal = n,
                     .gap = gap,
                     .pair = pair_key(a.key, b.key),
                     .feature = c.point.name};
      Ends ends{p.pair, p.feature, s.anchor(c.triangle_a, x), o ? o->anchor(c.triangle_b, y) : Anchor{}};
      if (a.key > b.key) {
        p.exchange_bodies();
        std::swap(ends.a, ends.b);
      }
      contacts.push_back(p);
      all.ends_.push_back(ends);
    }
  }

  /// Behind a side of a sheet is in front of the other, which speaks for it.
  static bool is_other_side(const inner::SoftSurface& s, const inner::SoftSurface* o, std::uint32_t name) {
    return (inner::is_vertex_of_a(name) || s.is_sheet()) &&
           (inner::is_vertex_of_b(name) || (o && o->is_sheet()));
  }
  /// A feature passes through a body that a joint, or the host, ties to one of its nodes.
  bool lets(const inner::SoftSurface& s, Index t, const Vec3& shares, std::uint32_t other) const {
    for (int k = 0; k < 3; ++k)
      if (shares[k] > 0 && !filter.lets(pair_key(collider_key(s.set(), s.block(t, k)), other))) return false;
    return true;
  }
};

}  // namespace delassus
