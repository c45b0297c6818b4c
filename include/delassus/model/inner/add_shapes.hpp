/// The shapes of a machine: one of its own, or a compound about the centre of mass.
#pragma once

#include <delassus/core/roles.hpp>
#include <delassus/geometry/compound.hpp>
#include <delassus/geometry/convex_hull.hpp>
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
  if constexpr (requires { backend.add(Compound{}); }) return &backend;
  else if constexpr (requires { backend.backend; }) return compound_layer(backend.backend);
  else return static_cast<int*>(nullptr);
}
/// The same of what lets named pairs pass.
template <class Backend, class World>
auto* filter_layer(Backend& backend, const World& world) {
  if constexpr (requires { backend.ignore(world, Anchor{}, Anchor{}); }) return &backend;
  else if constexpr (requires { backend.backend; }) return filter_layer(backend.backend, world);
  else return static_cast<int*>(nullptr);
}

/// Shapes of a model as the library's, with their hulls; and those that it does not have.
class ModelShapes {
 public:
  explicit ModelShapes(const Model& model) : model_(model) {}

  struct Placed {
    Shape shape;
    Pose pose;  ///< in the frame that was asked for
  };
  /// A height field, and a mesh triangle by triangle, have no convex shape: `kind` none.
  Placed placed(const model::Geometry& geometry, const Pose& frame) {
    Placed out{{}, Lumps::in(frame, geometry.pose)};
    std::visit(
        [&](const auto& s) {
          using S = std::remove_cvref_t<decltype(s)>;
          if constexpr (std::is_same_v<S, model::Plane>) out.shape = HalfSpace{};
          else if constexpr (std::is_same_v<S, model::HullOf>) out.shape = hull(s.mesh);
          else if constexpr (!std::is_same_v<S, model::TrianglesOf> && !std::is_same_v<S, model::FieldOf>) out.shape = s;
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

}  // namespace delassus::inner
