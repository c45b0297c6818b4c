/// The bodies of a machine: one for each lump that moves, and the shapes that stand in the world.
#pragma once

#include <delassus/geometry/compound.hpp>
#include <delassus/model/inner/add_shapes.hpp>
#include <delassus/model/inner/contact_kinds.hpp>
#include <delassus/model/inner/lift.hpp>
#include <delassus/model/inner/lumps.hpp>
#include <delassus/model/inner/surface_kinds.hpp>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

/// Shapes of one lump, and which geometries of the model they are.
struct LumpShapes {
  std::vector<ModelShapes::Placed> placed;
  std::vector<Index> geometries;
};

template <class Builder>
LumpShapes shapes_of(Builder& builder, std::size_t l) {
  LumpShapes out;
  if (!builder.has_contacts()) return out;
  const Model& model = builder.model();
  for (const Index g : builder.lumps().all[l].shapes) {
    const model::Geometry& geometry = model.geometries[std::size_t(g)];
    if (geometry.type == 0 && geometry.affinity == 0 && !is_paired(model, g)) continue;
    if (!Builder::collides) {
      builder.miss("Contact{...}");
      break;
    }
    const Pose frame =
        geometry.body < 0 ? builder.pose() : builder.lumps().in_root[std::size_t(geometry.body)];
    builder.speak_of("geometry", geometry.name);
    builder.checked([&] {
      ModelShapes::Placed placed = builder.shapes().placed(geometry, frame);
      if (l == 0) give_surface(builder, geometry, placed.shape);
      if (placed.shape.kind == ShapeKind::none || (l > 0 && placed.shape.kind == ShapeKind::half_space))
        return builder.leave("geometry '" + geometry.name + "' has no shape here and meets nothing" +
                             (l == 0 ? "; put WithMeshes{...} around the collision of the loop" : ""));
      out.placed.push_back(placed), out.geometries.push_back(g);
    });
  }
  return out;
}

/// Parts of one body of which the frame's origin is at `centre`.
template <class Builder>
Shape compound(Builder& builder, const std::vector<ModelShapes::Placed>& placed, const Vec3& centre) {
  if constexpr (Builder::collides) {
    auto* layer = compound_layer(builder.backend());
    if constexpr (std::is_same_v<decltype(layer), int*>) {
      builder.miss("WithCompounds{...}");
    } else {
      std::vector<CompoundPart> parts;
      for (const auto& [shape, pose] : placed)
        parts.push_back({.shape = shape, .position = pose.position, .orientation = Quat(pose.rotation)});
      Compound made(parts);
      made.move_frame(centre);
      if (!builder.is_looking()) return layer->add(std::move(made));
    }
  }
  return {};
}

/// Whom a body with these shapes meets, and what its surface is like.
template <class Builder>
void mark(Builder& builder, RigidBody& body, const std::vector<Index>& geometries) {
  const Model& model = builder.model();
  const ContactKind kind = contact_kind(model, geometries);
  if (builder.is_looking()) return builder.contact_kinds().note(kind);
  builder.contact_kinds().mark(body, kind);
  if constexpr (Builder::collides) {
    if (builder.leave_out().surfaces || geometries.empty()) return;
    const auto surface = [&](Index g) { return SurfaceKind(model, g); };
    body.material = builder.surface_kinds().number_of(builder.loop().materials(), surface(geometries[0]));
    for (const Index g : geometries)
      if (!(surface(g) == surface(geometries[0])))
        return builder.leave("all of the body of geometry '" + model.geometries[std::size_t(g)].name +
                             "' has the surface of geometry '" +
                             model.geometries[std::size_t(geometries[0])].name + "'");
  }
}

/// A body that a shape of the world is.
template <class Builder>
RigidBodies::Handle add_still(Builder& builder, const ModelShapes::Placed& own, Index geometry) {
  RigidBody body{.position = own.pose.position, .orientation = Quat(own.pose.rotation)};
  body.shape = own.shape;
  body.motion = Motion::fixed;
  mark(builder, body, {geometry});
  RigidBodies nobody;
  return (builder.is_looking() ? nobody : builder.set()).add(body);
}

/// The links that the world holds, and their shapes.
template <class Builder>
void add_world(Builder& builder) {
  const LumpShapes shapes = shapes_of(builder, 0);
  for (std::size_t b = 0; b < builder.model().bodies.size(); ++b)
    if (builder.lumps().of[b] == 0)
      builder.machine().parts[b] = {.body = {}, .is_world = true, .pose = builder.lumps().in_root[b]};
  for (std::size_t k = 0; k < shapes.placed.size(); ++k) {
    const model::Geometry& geometry = builder.model().geometries[std::size_t(shapes.geometries[k])];
    builder.speak_of("geometry", geometry.name);
    builder.checked([&] {
      const RigidBodies::Handle body = add_still(builder, shapes.placed[k], shapes.geometries[k]);
      if (!builder.is_looking()) builder.still().push_back({geometry.body, body});
    });
  }
}

template <class Builder>
void add_body(Builder& builder, std::size_t l) {
  const Model& model = builder.model();
  const Lump& lump = builder.lumps().all[l];
  const LumpShapes shapes = shapes_of(builder, l);
  const model::Body& root = model.bodies[std::size_t(lump.root)];
  Pose own{lump.mass.centre, identity<Mat3>()};  // of the body of the loop, in the root
  Shape shape;
  builder.speak_of("body", root.name);
  builder.checked([&] {
    if (shapes.placed.size() == 1 && norm(Vec3(shapes.placed[0].pose.position - own.position)) < 1e-9) {
      shape = shapes.placed[0].shape;
      own.rotation = shapes.placed[0].pose.rotation;
    } else if (!shapes.placed.empty()) {
      shape = compound(builder, shapes.placed, own.position);
    }
    const Pose at = Lumps::in(builder.world(lump.root), own);
    RigidBody body{.position = at.position, .orientation = Quat(at.rotation)};
    body.shape = shape;
    body.motion = root.is_kinematic ? Motion::kinematic : Motion::dynamic;
    if (!root.is_kinematic) {
      body.mass = lump.mass.mass;
      body.inertia = Mat3(own.rotation.transpose() * lump.mass.inertia * own.rotation);
    }
    mark(builder, body, shapes.geometries);
    RigidBodies nobody;
    const RigidBodies::Handle handle = (builder.is_looking() ? nobody : builder.set()).add(body);
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      if (builder.lumps().of[b] == Index(l))
        builder.machine().parts[b] = {
            .body = handle, .is_world = false, .pose = own.to_local(builder.lumps().in_root[b])};
    model::Lift lift = lift_of(model, builder.lumps(), l, own);
    lift.body = handle;
    if (!root.is_kinematic && (lift.mass != 0 || !is_zero(lift.moment)))
      builder.machine().lifts.push_back(lift);
  });
}

template <class Builder>
void add_bodies(Builder& builder) {
  builder.machine().parts.resize(builder.model().bodies.size());
  add_world(builder);
  for (std::size_t l = 1; l < builder.lumps().all.size(); ++l) add_body(builder, l);
}

}  // namespace delassus::inner
