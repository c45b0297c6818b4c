/// Links that no joint parts are one rigid body: their masses together.
#pragma once

#include <delassus/bodies/body_input.hpp>
#include <delassus/model/model.hpp>

#include <string>
#include <vector>

namespace delassus::inner {

/// Bodies of a model that move as one, and what they are together.
struct Lump {
  Index root = -1;            ///< the link that a joint moves, or that is kinematic; −1: the world
  MassProperties mass;        ///< in the frame of the root
  std::vector<Index> shapes;  ///< its geometries
};

/// Of each body: its lump, and where it is in the frame of the lump's root, or in the world.
struct Lumps {
  std::vector<Lump> all;     ///< the world first, then in the order of their roots
  std::vector<Index> of;     ///< by body
  std::vector<Pose> in_root; ///< by body

  Lumps(const Model& model, const Pose& pose, bool fixes_roots, bool frees_roots) {
    all.emplace_back();
    of.resize(model.bodies.size());
    in_root.resize(model.bodies.size());
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const model::Body& body = model.bodies[b];
      const bool is_root = body.parent < 0;
      const bool moves = body.is_kinematic || (is_root ? frees_roots || (!body.joints.empty() && !(fixes_roots && is_free(model, body)))
                                                       : !body.joints.empty());
      if (moves) {
        of[b] = Index(all.size());
        all.push_back({.root = Index(b), .mass = {}, .shapes = {}});
      } else {
        of[b] = is_root ? 0 : of[std::size_t(body.parent)];
        in_root[b] = is_root ? in(pose, body.pose) : in(in_root[std::size_t(body.parent)], body.pose);
      }
      if (of[b] > 0) add(all[std::size_t(of[b])].mass, body, in_root[b]);
    }
    for (std::size_t g = 0; g < model.geometries.size(); ++g) {
      const Index body = model.geometries[g].body;
      all[body < 0 ? 0 : std::size_t(of[std::size_t(body)])].shapes.push_back(Index(g));
    }
  }

  static Pose in(const Pose& outer, const Pose& own) { return {outer.to_world(own.position), outer.rotation * own.rotation}; }
  static bool is_free(const Model& model, const model::Body& body) {
    return body.joints.size() == 1 && model.joints[std::size_t(body.joints[0])].kind == model::JointKind::free;
  }

 private:
  /// m, c and I of both, I about the common centre.
  static void add(MassProperties& sum, const model::Body& body, const Pose& pose) {
    if (!(body.mass > 0)) return;
    const Vec3 centre = pose.to_world(body.centre);
    const Mat3 own = pose.rotation * body.inertia * pose.rotation.transpose();
    const double mass = sum.mass + body.mass;
    const Vec3 common = (sum.mass * sum.centre + body.mass * centre) / mass;
    sum.inertia = about(sum.inertia, sum.mass, sum.centre - common) + about(own, body.mass, centre - common);
    sum.mass = mass;
    sum.centre = common;
  }
  static Mat3 about(const Mat3& inertia, double mass, const Vec3& d) {
    return inertia + mass * (squared_norm(d) * identity<Mat3>() - d * d.transpose());
  }
};

}  // namespace delassus::inner
