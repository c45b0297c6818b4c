/// The shapes of a machine: one of its own, or a compound about the centre of mass.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/geometry/compound.hpp>
#include <delassus/geometry/convex_hull.hpp>
#include <delassus/geometry/height_field.hpp>
#include <delassus/geometry/triangle_mesh.hpp>
#include <delassus/math/rotation.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/rows/anchor.hpp>

#include <deque>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace delassus::inner {

/// What keeps compounds among the layers of a backend; null where none does.
template <class Backend>
auto* compound_layer(Backend& backend) {
  if constexpr (requires { backend.add(Compound{}); })
    return &backend;
  else if constexpr (requires { backend.backend; })
    return compound_layer(backend.backend);
  else
    return static_cast<int*>(nullptr);
}
/// The same of what keeps height fields and triangles.
template <class Backend>
auto* mesh_layer(Backend& backend) {
  if constexpr (requires { backend.add(HeightField{}); })
    return &backend;
  else if constexpr (requires { backend.backend; })
    return mesh_layer(backend.backend);
  else
    return static_cast<int*>(nullptr);
}
/// The same of what lets named pairs pass.
template <class Backend, class World>
auto* filter_layer(Backend& backend, const World& world) {
  if constexpr (requires { backend.ignore(world, Anchor{}, Anchor{}); })
    return &backend;
  else if constexpr (requires { backend.backend; })
    return filter_layer(backend.backend, world);
  else
    return static_cast<int*>(nullptr);
}

/// Shapes of a model as the library's, with their hulls; and those that it does not have.
class ModelShapes {
 public:
  explicit ModelShapes(const Model& model) : model_(model) {}

  struct Placed {
    Shape shape;
    Pose pose;  ///< in the frame that was asked for
  };
  /// A height field, and a mesh triangle by triangle, have no convex shape: `kind` none, see `give_surface`.
  Placed placed(const model::Geometry& geometry, const Pose& frame) {
    Placed out{{}, Lumps::in(frame, geometry.pose)};
    std::visit(
        [&](const auto& s) {
          using S = std::remove_cvref_t<decltype(s)>;
          if constexpr (std::is_same_v<S, model::Plane>)
            out.shape = HalfSpace{};
          else if constexpr (std::is_same_v<S, model::HullOf>)
            out.shape = hull(s.mesh);
          else if constexpr (!std::is_same_v<S, model::TrianglesOf> && !std::is_same_v<S, model::FieldOf>)
            out.shape = s;
        },
        geometry.shape);
    return out;
  }

 private:
  Shape hull(Index mesh) {
    for (const auto& [number, made] : hulls_)
      if (number == mesh) return made;
    hulls_.emplace_back(mesh, ConvexHull(model_.meshes[std::size_t(mesh)].vertices));
    return hulls_.back().second;
  }

  const Model& model_;
  std::deque<std::pair<Index, ConvexHull>> hulls_;
};

/// f(surface) with the height field or the triangles that a geometry names; nothing for another one.
template <class F>
void with_surface_of(const Model& model, const model::Geometry& geometry, const F& f) {
  if (const auto* of = std::get_if<model::FieldOf>(&geometry.shape)) {
    const model::HeightField& h = model.height_fields[std::size_t(of->field)];
    f(HeightField(h.columns, h.rows, 2 * h.half_x / (h.columns - 1), 2 * h.half_y / (h.rows - 1), h.heights));
  }
  if (const auto* of = std::get_if<model::TrianglesOf>(&geometry.shape)) {
    const model::Mesh& mesh = model.meshes[std::size_t(of->mesh)];
    f(TriangleMesh(mesh.vertices, mesh.triangles));
  }
}

/// Gives `shape` the surface of a geometry, where the loop's collision keeps surfaces. Who only looks on is
/// given a stand-in.
template <class Builder>
void give_surface(Builder& builder, const model::Geometry& geometry, Shape& shape) {
  if constexpr (Builder::collides) {
    auto* layer = mesh_layer(builder.backend());
    if constexpr (!std::is_same_v<decltype(layer), int*>)
      with_surface_of(builder.model(), geometry, [&](auto surface) {
        if (builder.is_looking())
          shape = Sphere{1};
        else
          shape = layer->add(std::move(surface));
      });
  }
}

}  // namespace delassus::inner
