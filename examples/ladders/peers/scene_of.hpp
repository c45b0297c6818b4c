/// Takes the scene off a loop that stands complete, and puts what another engine made of it back into the
/// loop.
#pragma once

#include "scene.hpp"

#include <delassus/delassus.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace ladders::peers {

using delassus::Index, delassus::Vec3, delassus::Quat, delassus::Mat3;

inline Triple triple(const Vec3& x) { return {x[0], x[1], x[2]}; }
inline Vec3 vec(const Triple& x) { return {x[0], x[1], x[2]}; }
inline Quadruple quadruple(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }
inline Quat quat(const Quadruple& q) { return Quat(q[0], q[1], q[2], q[3]); }

/// A scene, and which block of the loop's rigid bodies each body is. `axes` turns the principal axes, the
/// frame of a body of the scene, into the frame of the block.
struct Told {
  Scene scene;
  std::vector<Index> blocks;
  std::vector<Quat> axes;
};

namespace inner {

/// The principal moments, and the rotation whose columns are their axes; none where the axes are the body's.
inline void tell_inertia(const Mat3& inertia, Triple& moments, Quat& axes) {
  moments = triple(inertia.diagonal());
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.norm() <= 1e-14 * inertia.norm()) return;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(inertia);
  Mat3 R = eigen.eigenvectors();
  if (R.determinant() < 0) R.col(0) = -R.col(0);
  moments = triple(eigen.eigenvalues());
  axes = Quat(R).normalized();
}

inline Geometry tell_shape(const delassus::Shape& shape, const Quat& axes) {
  using enum delassus::ShapeKind;
  Geometry out{.form = Form::none};
  std::copy(shape.size.begin(), shape.size.end(), out.size.begin());
  switch (shape.kind) {
    case none:
      return {};
    case half_space:
      out.form = Form::half_space;
      break;
    case box:
      out.form = Form::box;
      break;
    case sphere:
      out.form = Form::sphere;
      break;
    case capsule:
      out.form = Form::capsule;
      break;
    case cylinder:
      out.form = Form::cylinder;
      break;
    case convex_hull:
      out.form = Form::convex;
      for (const Vec3& x : shape.hull->vertices()) out.corners.push_back(triple(axes.conjugate() * x));
      return out;
    default:
      throw Unsayable(std::string("needs a ") + delassus::name(shape.kind));
  }
  if (!axes.isApprox(Quat::Identity()) && out.form != Form::sphere)
    throw Unsayable("needs an inertia off the axes of its shape");
  return out;
}

inline State tell_state(const auto& set, Index b, const Quat& axes) {
  const auto body = set.handle(b);
  return {triple(set.position(body)), quadruple((set.orientation(body) * axes).normalized()),
          triple(set.velocity(body)), triple(set.angular_velocity(body))};
}

template <class Law>
constexpr const char* what_it_needs() {
  using namespace delassus;
  if constexpr (std::is_same_v<Law, Gear>)
    return "needs gears";
  else if constexpr (std::is_same_v<Law, Screw>)
    return "needs a screw";
  else if constexpr (std::is_same_v<Law, Planar>)
    return "needs a planar joint";
  else if constexpr (std::is_same_v<Law, DistanceJoint>)
    return "needs a distance joint";
  else if constexpr (std::is_same_v<Law, Limit<Turn>>)
    return "needs limits of joints";
  else if constexpr (std::is_same_v<Law, Motor<Turn>>)
    return "needs motors";
  else if constexpr (std::is_same_v<Law, Drive<Turn>>)
    return "needs an implicit drive";
  else
    return "needs a joint that the description has no word for";
}

template <class Law>
constexpr int hold_of() {
  using namespace delassus;
  if constexpr (std::is_same_v<Law, BallJoint>)
    return int(Hold::ball);
  else if constexpr (std::is_same_v<Law, Hinge>)
    return int(Hold::hinge);
  else if constexpr (std::is_same_v<Law, Slider>)
    return int(Hold::slider);
  else if constexpr (std::is_same_v<Law, Weld>)
    return int(Hold::weld);
  else
    return -1;
}

template <class Law>
void tell_law(const delassus::Pool<Law>& pool, Told& told, const std::vector<int>& place) {
  if constexpr (delassus::ContactLaw<Law>) {
    told.scene.touches = true;
    const auto p = pool.law.law.parameters();
    if constexpr (requires { p.friction; }) told.scene.friction = p.friction;
    if constexpr (requires { p.restitution; }) told.scene.restitution = p.restitution;
  } else {
    if (pool.count() == 0) return;
    if constexpr (hold_of<Law>() < 0)
      throw Unsayable(what_it_needs<Law>());
    else
      for (Index i = 0; i < pool.count(); ++i) {
        const auto& item = pool.item(i);
        Joint joint{.hold = Hold(hold_of<Law>())};
        const auto end = [&](const delassus::Anchor& anchor, int& body, Triple& point, Quadruple& frame) {
          const Quat axes =
              anchor.is_world() ? Quat::Identity() : told.axes[std::size_t(place[std::size_t(anchor.block)])];
          body = anchor.is_world() ? -1 : place[std::size_t(anchor.block)];
          point = triple(axes.conjugate() * anchor.local);
          frame = quadruple((axes.conjugate() * anchor.frame).normalized());
        };
        end(item.a, joint.a, joint.on_a, joint.frame_a);
        end(item.b, joint.b, joint.on_b, joint.frame_b);
        told.scene.joints.push_back(joint);
      }
  }
}

inline void tell_bodies(const auto& set, Told& told, std::vector<int>& place) {
  using namespace delassus;
  if constexpr (std::is_same_v<std::remove_cvref_t<decltype(set)>, RigidBodies>) {
    told.scene.gravity = triple(set.gravity);
    place.assign(std::size_t(set.blocks()), -1);
    for (const Index b : alive(set)) {
      if (set.motion(b) == Motion::kinematic) throw Unsayable("needs a kinematic body");
      if (set.material(b) != 0 || set.group(b) != 1 || set.collides_with(b) != ~0u)
        throw Unsayable("needs materials or groups");
      Body body{.is_fixed = set.motion(b) == Motion::fixed};
      Quat axes = Quat::Identity();
      if (!body.is_fixed) {
        body.mass = set.mass(b);
        tell_inertia(set.inertia(b), body.moments, axes);
      }
      body.geometry = tell_shape(set.shape(b), axes);
      body.start = tell_state(set, b, axes);
      place[std::size_t(b)] = int(told.blocks.size());
      told.scene.bodies.push_back(body);
      told.blocks.push_back(b);
      told.axes.push_back(axes);
    }
  } else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(set)>, Particles>) {
    throw Unsayable("needs particles");
  } else {
    throw Unsayable("needs a deformable");
  }
}

}  // namespace inner

/// The scene of a loop of rigid bodies. Throws Unsayable with what the description has no word for.
template <class Loop>
Told scene_of(const Loop& loop) {
  Told told;
  std::vector<int> place;
  loop.world().each([&](const auto& set, auto) { inner::tell_bodies(set, told, place); });
  const auto& laws = loop.template policy<delassus::role::Constraints>();
  delassus::for_each_index<Loop::Laws::pool_count>(
      [&](auto p) { inner::tell_law(laws.template pool<p>(), told, place); });
  return told;
}

namespace inner {

/// f(set) for the rigid bodies of a loop; a scene that could be told has no others.
template <class Loop, class F>
void in_rigid_bodies(Loop& loop, F&& f) {
  loop.world().each([&](auto& set, auto) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(set)>, delassus::RigidBodies>) f(set);
  });
}

}  // namespace inner

/// The states of the scene's bodies in the loop now.
template <class Loop>
void read_states(const Loop& loop, const Told& told, std::vector<State>& states) {
  states.resize(told.blocks.size());
  inner::in_rigid_bodies(loop, [&](const auto& set) {
    for (std::size_t k = 0; k < states.size(); ++k)
      states[k] = inner::tell_state(set, told.blocks[k], told.axes[k]);
  });
}

/// Puts the loop's bodies where the states say.
template <class Loop>
void write_states(Loop& loop, const Told& told, std::span<const State> states) {
  inner::in_rigid_bodies(loop, [&](auto& set) {
    for (std::size_t k = 0; k < states.size(); ++k) {
      if (told.scene.bodies[k].is_fixed) continue;
      const auto body = set.handle(told.blocks[k]);
      set.place(body, vec(states[k].position), quat(states[k].turn) * told.axes[k].conjugate());
      set.set_velocity(body, vec(states[k].velocity), vec(states[k].spin));
    }
  });
}

/// f(body, force, torque) for what the user applied for the next step; it is taken off the loop.
template <class Loop, class F>
void take_loads(Loop& loop, const Told& told, F&& f) {
  inner::in_rigid_bodies(loop, [&](auto& set) {
    for (std::size_t k = 0; k < told.blocks.size(); ++k) {
      auto& load = set.loads()[std::size_t(told.blocks[k])];
      if (load.isZero(0)) continue;
      f(int(k), Triple{load[0], load[1], load[2]}, Triple{load[3], load[4], load[5]});
      load.setZero();
    }
  });
}

}  // namespace ladders::peers
