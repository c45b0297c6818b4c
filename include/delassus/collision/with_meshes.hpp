/// Detection with surfaces of triangles beside the convex shapes: meshes and height fields.
#pragma once

#include <delassus/collision/inner/surface_pairs.hpp>
#include <delassus/collision/inner/wrapped.hpp>
#include <delassus/collision/native_engine.hpp>
#include <delassus/core/archive.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/if_it_has.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/geometry/height_field.hpp>
#include <delassus/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus {

/// `WithMeshes{NativeCollision{}}` in the place of the backend: Convex pairs are the backend's. Bodies with a shape that `add`
/// returned meet convex ones and half-spaces by their triangles, and each other by their vertices, edges and triangles. The
/// solid is behind the triangles, so a convex body whose middle is behind one does not meet it. A mesh wholly inside a closed
/// one is pushed out. `WithFilter` goes around it.
template <class Backend = inner::Absent>
struct WithMeshes {
  using plays = role::Collision;
  static constexpr unsigned layers = inner::layers_of<Backend> | inner::layer::meshes;
  /// Around what is no backend, or in another order; the loop's checks say so.
  static constexpr bool is_hollow = !inner::Detects<Backend, inner::layer::meshes>;

  Backend backend{};  ///< meets all but the surfaces

  WithMeshes() = default;
  /// Around this backend.
  explicit WithMeshes(Backend b) : backend(std::move(b)) {}

  /// Keeps a surface; the shape it returns is for bodies of the loop that has this backend, as many as
  /// wanted.
  Shape add(TriangleMesh mesh) {
    DELASSUS_EXPECT(mesh.triangle_count() > 0, "this mesh has no triangle; give it some");
    const inner::Bounds bounds = mesh.bounds();
    meshes_.push_back(std::move(mesh));
    return kept(false, Index(meshes_.size()) - 1, bounds);
  }
  /// The same for a height field; throws where it has no point.
  Shape add(HeightField field) {
    DELASSUS_EXPECT(field.triangle_count() > 0, "this height field has no point; give it some");
    const inner::Bounds bounds = field.bounds();
    fields_.push_back(std::move(field));
    return kept(true, Index(fields_.size()) - 1, bounds);
  }

  /// f(surface), the mesh or the height field that a shape of `add` names.
  template <class F>
  void with_surface(const Shape& shape, const F& f) const {
    const auto& [is_field, place] = kind_of(shape);
    is_field ? f(fields_[place]) : f(meshes_[place]);
  }

  void check() const { inner::check_if_it_can(backend); }

  template <class Filter = NoFilter>
  CollisionReport detect(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts,
                         const Filter& filter = {}) {
    take_convex(colliders);
    CollisionReport report = backend.detect(convex_, h, contacts, filter);
    find_jobs(colliders, h, filter);
    report.pairs += Index(jobs_.size());
    pairs_.begin(inner::KnowsWhoPushed<Filter>);
    const CollisionSettings settings = inner::settings_of(backend);
    for (const Job& job : jobs_)
      with_surface(colliders[job.a].shape, [&](const auto& surface) {
        if (colliders[job.b].shape.kind == ShapeKind::mesh)
          report.queries += cross(surface, colliders, job, h, settings, contacts);
        else
          report.queries += pairs_.collide(surface, colliders, job, h, settings, filter, contacts);
      });
    pairs_.end();
    if (!jobs_.empty()) inner::sort_by_name(contacts);
    report.points = Index(contacts.size());
    return report;
  }

  /// Of two surfaces none is left out.
  template <class Filter>
  void detect_missed(std::span<const Collider> colliders, double h, std::vector<ContactPoint>& contacts, const Filter& filter)
    requires inner::DetectsMissed<Backend, Filter>
  {
    take_convex(colliders);
    backend.detect_missed(convex_, h, contacts, filter);
    find_jobs(colliders, h, filter);
    const CollisionSettings settings = inner::settings_of(backend);
    for (const Job& job : jobs_)
      if (colliders[job.b].shape.kind != ShapeKind::mesh)
        with_surface(colliders[job.a].shape,
                     [&](const auto& surface) { pairs_.collide_missed(surface, colliders, job, h, settings, contacts); });
    inner::sort_by_name(contacts);
  }

  void memory(auto& archive) {
    if constexpr (!inner::leaves_shapes<std::remove_cvref_t<decltype(archive)>>) archive(meshes_, fields_, kinds_);
    archive(pairs_);
    inner::remember(backend, archive);
  }

 private:
  using Job = inner::PairJob;
  struct Kind {
    bool is_field;
    Index place;
  };

  Shape kept(bool is_field, Index place, const inner::Bounds& bounds) {
    kinds_.push_back({is_field, place});
    Vec3 reach;
    for (int k = 0; k < 3; ++k) reach[k] = std::max(std::abs(bounds.low[k]), std::abs(bounds.high[k]));
    return KeptShape{ShapeKind::mesh, int(kinds_.size()) - 1, reach};
  }

  void take_convex(std::span<const Collider> colliders) {
    convex_.assign(colliders.begin(), colliders.end());
    for (Collider& c : convex_)
      if (c.shape.kind == ShapeKind::mesh) c.shape = {};
  }

  /// Of pairs whose balls, with the widest margin there can be, are apart nothing is asked.
  template <class Filter>
  void find_jobs(std::span<const Collider> colliders, double h, const Filter& filter) {
    jobs_.clear();
    for (Index m = 0; m < Index(colliders.size()); ++m) {
      const Collider& mesh = colliders[m];
      if (mesh.shape.kind != ShapeKind::mesh || !is_finite(mesh.pose.position) ||
          !is_finite(mesh.pose.rotation))
        continue;
      for (Index i = 0; i < Index(colliders.size()); ++i) {
        const Collider& other = colliders[i];
        const ShapeKind kind = other.shape.kind;
        if (kind == ShapeKind::none || kind == ShapeKind::compound || !may_meet(mesh, other) ||
            (kind == ShapeKind::mesh && !goes_first(colliders, m, i)))
          continue;
        const std::uint64_t pair = pair_key(mesh.key, other.key);
        if (is_near(mesh, other, h) && filter.lets(pair)) jobs_.push_back({pair, m, i});
      }
    }
    inner::sort(jobs_);
  }

  const Kind& kind_of(const Shape& shape) const {
    const Index number = Index(shape.number());
    DELASSUS_EXPECT(shape.kind == ShapeKind::mesh && number < Index(kinds_.size()),
                    "this mesh is none of the backend's; take what its add(...) returned");
    return kinds_[number];
  }

  /// Of two surfaces a mesh goes before a height field, else the lower key.
  bool goes_first(std::span<const Collider> colliders, Index i, Index j) const {
    const Collider &a = colliders[i], &b = colliders[j];
    if (i == j) return false;
    const bool a_is_field = kind_of(a.shape).is_field, b_is_field = kind_of(b.shape).is_field;
    return a_is_field != b_is_field ? b_is_field : a.key < b.key;
  }

  template <class Surface>
  Index cross(const Surface& surface, std::span<const Collider> colliders, const Job& job, double h,
              const CollisionSettings& settings, std::vector<ContactPoint>& contacts) {
    Index queries = 0;
    with_surface(colliders[job.b].shape, [&](const auto& other) {
      constexpr bool is_field_on_mesh = std::is_same_v<Surface, HeightField> &&
                                        std::is_same_v<std::remove_cvref_t<decltype(other)>, TriangleMesh>;
      if constexpr (!is_field_on_mesh)  // the mesh goes first
        queries = pairs_.cross(surface, other, colliders, job, h, settings, contacts);
    });
    return queries;
  }

  bool is_near(const Collider& mesh, const Collider& other, double h) const {
    if (other.shape.kind == ShapeKind::half_space) return true;
    const CollisionSettings settings = inner::settings_of(backend);
    const double own = outer_radius(other.shape),
                 margin = std::max(settings.margin, own) + settings.contact_distance,
                 reach = outer_radius(mesh.shape) + own + margin + h * (inner::top_speed(mesh) + inner::top_speed(other));
    return squared_norm(mesh.pose.position - other.pose.position) <= reach * reach;
  }

  std::vector<TriangleMesh> meshes_;
  std::vector<HeightField> fields_;
  Array<Kind> kinds_;
  std::vector<Collider> convex_;
  Array<Job> jobs_;
  inner::SurfacePairs pairs_;
};

}  // namespace delassus
