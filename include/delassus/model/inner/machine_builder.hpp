/// Turns a model into bodies and constraints of a loop.
#pragma once

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/constraints/joints/limit.hpp>
#include <delassus/constraints/joints/motor.hpp>
#include <delassus/constraints/joints/rotation_angle.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/constraints/joints/serial_joint.hpp>
#include <delassus/constraints/joints/slider.hpp>
#include <delassus/constraints/joints/spring_damper.hpp>
#include <delassus/constraints/joints/weld.hpp>
#include <delassus/model/inner/add_actuators.hpp>
#include <delassus/model/inner/add_shapes.hpp>
#include <delassus/model/inner/add_tendons.hpp>
#include <delassus/model/inner/chains.hpp>
#include <delassus/model/machine.hpp>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus::inner {

template <class Loop>
class MachineBuilder {
  static constexpr bool collides = Loop::Laws::has_contacts;
 public:
  MachineBuilder(Loop& loop, const Model& model, const Lumps& lumps, const Pose& pose, const LeaveOut& leave_out)
      : loop_(loop), set_(bodies<RigidBodies>(loop.world())), model_(model), lumps_(lumps), pose_(pose), leave_out_(leave_out), shapes_(model) {
    world_pose_.resize(model.bodies.size());
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const Index parent = model.bodies[b].parent;
      world_pose_[b] = Lumps::in(parent < 0 ? pose : world_pose_[std::size_t(parent)], model.bodies[b].pose);
    }
    for (std::size_t l = 1; l < lumps.all.size(); ++l) chains_.push_back(chain_of(model, lumps.all[l].root, world_pose_[std::size_t(lumps.all[l].root)]));
  }

  /// One sentence with all laws and layers that the loop does not name.
  void refuse_what_is_missing() {
    is_looking_ = true;
    add_all();
    is_looking_ = false;
    machine_ = {};
    if (missing_.empty()) return;
    std::string list;
    for (const std::string& law : missing_) list += (list.empty() ? "" : ", ") + law;
    refuse("add: model '" + model_.name + "' needs what this loop does not name: " + list +
           "; add it to Constraints{...} or to the collision of the loop, or leave it out by LeaveOut");
  }

  Machine made() {
    add_all();
    return std::move(machine_);
  }

  // --- what `add_tendons` and `add_actuators` use ----------------------------------------------------------------

  template <class Law>
  static constexpr bool names = !std::is_void_v<typename Loop::Laws::template law_of<typename Law::Item>::type>;

  /// Adds the item of a law that the loop names, or notes the law.
  template <class Law, class MakeItem>
  model::ConstraintNumber emit(const char* name, const MakeItem& item) {
    if constexpr (names<Law>) {
      if (is_looking_) return {};
      const auto handle = loop_.add(item());
      return {handle.index, handle.generation, handle.owner};
    } else {
      miss(name);
      return {};
    }
  }
  void miss(const std::string& name) {
    if (std::find(missing_.begin(), missing_.end(), name) == missing_.end()) missing_.push_back(name);
  }
  void leave(const std::string& sentence) {
    machine_.left_out.push_back("model '" + model_.name + "': " + sentence);
  }
  const Model& model() const { return model_; }
  const LeaveOut& leave_out() const { return leave_out_; }
  Machine& machine() { return machine_; }

  bool moves_as_one(Index a, Index b) const {
    const auto lump = [&](Index body) { return body < 0 ? 0 : lumps_.of[std::size_t(body)]; };
    return lump(a) == lump(b);
  }
  /// Of a body, in the pose that the tree describes.
  Pose world(Index body) const { return body < 0 ? pose_ : world_pose_[std::size_t(body)]; }
  Index owner(Index joint) const {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b)
      if (std::ranges::count(model_.bodies[b].joints, joint) > 0) return Index(b);
    return -1;
  }
  /// Whether the machine has the joint, and nothing holds it.
  bool moves(Index joint) const {
    const Index body = owner(joint);
    if (body < 0 || model_.bodies[std::size_t(body)].is_kinematic) return false;
    const Index lump = lumps_.of[std::size_t(body)];
    return lump > 0 && lumps_.all[std::size_t(lump)].root == body;
  }
  Vec3 site(Index s) const {
    const model::Site& site = model_.sites[std::size_t(s)];
    return world(site.body).to_world(site.pose.position);
  }
  /// The end of a joint on a body of the model, at a place of the world in the pose of the tree.
  Anchor end(Index body, const Vec3& point, const Quat& frame = Quat::Identity()) const {
    if (is_looking_ || body < 0 || machine_.parts[std::size_t(body)].is_world) return world_anchor(point, frame);
    return anchor_at(set_, machine_.parts[std::size_t(body)].body, point, frame);
  }
  /// Between two ends, in the pose of the tree.
  double distance(const Anchor& a, const Anchor& b) const { return norm(Vec3(loop_.world().point(a) - loop_.world().point(b))); }
  /// As the loop knows it.
  Anchor resolved(Anchor end) const {
    if (!is_looking_) loop_.world().resolve(end, "add");
    return end;
  }

 private:
  void add_all() {
    machine_.parts.resize(model_.bodies.size());
    machine_.axes.resize(model_.joints.size());
    for (std::size_t l = 0; l < lumps_.all.size(); ++l) add_body(l);
    for (std::size_t k = 0; k < chains_.size(); ++k) add_chain(chains_[k]);
    if (!leave_out_.couplings) add_couplings();
    add_tendons(*this);
    add_actuators(*this);
    add_exclusions();
    leave_rest();
  }

  /// What has no law here.
  void leave_rest() {
    for (const model::Body& body : model_.bodies)
      if (body.gravity_compensation != 0) leave("the whole weight of body '" + body.name + "' acts");
    for (const model::Joint& joint : model_.joints)
      if ((joint.kind == model::JointKind::ball || joint.kind == model::JointKind::free) &&
          (joint.damping > 0 || joint.stiffness > 0 || joint.friction_loss > 0 || joint.armature > 0))
        leave("spring, damping, dry friction and rotor of joint '" + joint.name + "' do not act: it is a ball or free");
    if (leave_out_.contacts || !model_.contacts) return;
    const auto& all = model_.geometries;
    if (std::any_of(all.begin(), all.end(), [](const auto& g) { return g.friction != 1 || g.contact_freedoms != 3 || g.restitution != 0 || norm(g.surface_velocity) + norm(g.surface_spin) > 0; }))
      leave("all contacts have the law of the loop: friction, restitution and motion of single surfaces are not used");
    if (std::any_of(all.begin(), all.end(), [](const auto& g) { return (g.type != 1 || g.affinity != 1) && g.type + g.affinity != 0; }))
      leave("shapes meet whatever their types and affinities are");
    if (!model_.pairs.empty()) leave("its " + std::to_string(model_.pairs.size()) + " contact pairs have no numbers of their own");
  }

  // --- bodies --------------------------------------------------------------------------------------------------

  void add_body(std::size_t l) {
    const Lump& lump = lumps_.all[l];
    std::vector<ModelShapes::Placed> shapes;
    std::vector<Index> owners;  // of the shapes
    const Pose root = l == 0 ? Pose{} : world_pose_[std::size_t(lump.root)];
    if (!leave_out_.contacts && model_.contacts)
      for (const Index g : lump.shapes) {
        const model::Geometry& geometry = model_.geometries[std::size_t(g)];
        if (geometry.type == 0 && geometry.affinity == 0) continue;
        if (!collides) {
          miss("Contact{...}");
          break;
        }
        const Pose frame = geometry.body < 0 ? pose_ : lumps_.in_root[std::size_t(geometry.body)];
        shapes.push_back(shapes_.placed(geometry, frame));
        owners.push_back(geometry.body);
        if (shapes.back().shape.kind == ShapeKind::none || (l > 0 && shapes.back().shape.kind == ShapeKind::half_space)) {
          leave("geometry '" + geometry.name + "' has no shape here and meets nothing");
          shapes.pop_back(), owners.pop_back();
        }
      }
    if (l == 0) {
      for (std::size_t b = 0; b < model_.bodies.size(); ++b)
        if (lumps_.of[b] == 0) machine_.parts[b] = {.body = {}, .is_world = true, .pose = lumps_.in_root[b]};
      if (!is_looking_)
        for (std::size_t k = 0; k < shapes.size(); ++k)
          still_.push_back({owners[k], set_.add_fixed(shapes[k].shape, shapes[k].pose.position, Quat(shapes[k].pose.rotation))});
      return;
    }
    const bool is_kinematic = model_.bodies[std::size_t(lump.root)].is_kinematic;
    if (!is_kinematic) check_inertia(lump.mass.inertia, "add: model '" + model_.name + "': body '" + model_.bodies[std::size_t(lump.root)].name + "'");
    Pose own{lump.mass.centre, identity<Mat3>()};  // of the body of the loop, in the root
    Shape shape;
    if (shapes.size() == 1 && norm(Vec3(shapes[0].pose.position - own.position)) < 1e-9) {
      shape = shapes[0].shape;
      own.rotation = shapes[0].pose.rotation;
    } else if (!shapes.empty()) {
      shape = compound(shapes, own.position);
    }
    const Pose at = Lumps::in(root, own);
    RigidBodies::Handle handle{};
    if (!is_looking_)
      handle = set_.add({.position = at.position,
                         .orientation = Quat(at.rotation),
                         .mass = is_kinematic ? std::optional<double>{} : lump.mass.mass,
                         .inertia = is_kinematic ? std::optional<Mat3>{} : Mat3(own.rotation.transpose() * lump.mass.inertia * own.rotation),
                         .shape = shape,
                         .motion = is_kinematic ? Motion::kinematic : Motion::dynamic});
    for (std::size_t b = 0; b < model_.bodies.size(); ++b)
      if (lumps_.of[b] == Index(l)) machine_.parts[b] = {.body = handle, .is_world = false, .pose = own.to_local(lumps_.in_root[b])};
  }

  Shape compound(const std::vector<ModelShapes::Placed>& placed, const Vec3& centre) {
    if constexpr (collides) {
      auto* layer = compound_layer(loop_.data().template policy<role::Collision>());
      if constexpr (std::is_same_v<decltype(layer), int*>) miss("WithCompounds{...}");
      else if (!is_looking_) return compound_in(*layer, placed, centre);
    }
    return {};
  }
  static Shape compound_in(auto& layer, const std::vector<ModelShapes::Placed>& placed, const Vec3& centre) {
    std::vector<CompoundPart> parts;
    for (const auto& [shape, pose] : placed) parts.push_back({.shape = shape, .position = pose.position, .orientation = Quat(pose.rotation)});
    Compound made(parts);
    made.move_frame(centre);
    return layer.add(std::move(made));
  }

  // --- joints --------------------------------------------------------------------------------------------------

  void add_chain(const Chain& chain) {
    const Index parent = model_.bodies[std::size_t(chain.body)].parent, body = chain.body;
    if (chain.is_ball) {
      const Index j = model_.bodies[std::size_t(body)].joints[0];
      emit<BallJoint>("BallJoint{}", [&] { return BallJoint::Item{end(parent, chain.at, Quat::Identity()), end(body, chain.at, Quat::Identity())}; });
      const model::Joint& joint = model_.joints[std::size_t(j)];
      if (joint.is_limited && !leave_out_.limits)  // turned as the tree describes, its angle is 0
        emit<Limit<RotationAngle>>("Limit<RotationAngle>{}", [&] {
          return Limit<RotationAngle>::Item{.a = end(parent, chain.at), .b = end(body, chain.at), .upper = joint.upper};
        });
      return;
    }
    if (chain.is_free || chain.axes.empty()) return;
    const std::size_t slides = chain.slides.size(), hinges = chain.hinges.size();
    const Quat first = along(hinges > 0 ? chain.hinge(0) : chain.slide(0)), last = hinges > 0 ? along(chain.hinge(hinges - 1)) : first;
    const Anchor a = end(parent, chain.at, first), b = end(body, hinges == 2 ? chain.at_last : chain.at, hinges == 1 ? first : last);
    if (slides == 0 && hinges == 1) emit<Hinge>("Hinge{}", [&] { return Hinge::Item{a, b}; });
    else if (slides == 1 && hinges == 0) emit<Slider>("Slider{}", [&] { return Slider::Item{a, b}; });
    else add_serial(chain, a, b, first);

    for (std::size_t k = 0; k < slides; ++k) {
      const Quat frame = along(chain.slide(k));
      add_axis(chain.slides[k], {.kind = model::AxisKind::slide, .a = end(parent, chain.at, frame), .b = end(body, chain.at, frame)});
    }
    for (std::size_t k = 0; k < hinges; ++k) {
      const auto kind = hinges == 1 ? model::AxisKind::turn : k == 0 ? model::AxisKind::precession : k + 1 == hinges ? model::AxisKind::spin : model::AxisKind::nutation;
      const bool runs_backwards = kind == model::AxisKind::nutation && dot(chain.hinge(1), cross(chain.hinge(0), chain.hinge(2))) < 0;
      add_axis(chain.hinges[k], {.kind = kind, .a = a, .b = b, .sign = runs_backwards ? -1. : 1.});
    }
  }

  /// The law has its numbers of slides and hinges in its type.
  void add_serial(const Chain& chain, const Anchor& a, const Anchor& b, const Quat& frame) {
    const auto one = [&]<int s, int h>() {
      if (int(chain.slides.size()) != s || int(chain.hinges.size()) != h) return;
      const std::string name = "SerialJoint<" + std::to_string(s) + ", " + std::to_string(h) + ">{}";
      emit<SerialJoint<s, h>>(name.c_str(), [&] {
        const Vec3 slide = s == 1 ? chain.slide(0) : s == 2 ? cross(chain.slide(0), chain.slide(1)) : unit_axis(2);
        return typename SerialJoint<s, h>::Item{.a = a, .b = b, .slide = frame.conjugate() * slide, .cosine = chain.cosine, .offset = chain.offset};
      });
    };
    one.template operator()<0, 2>(), one.template operator()<0, 3>(), one.template operator()<1, 1>(), one.template operator()<1, 2>();
    one.template operator()<1, 3>(), one.template operator()<2, 0>(), one.template operator()<2, 1>(), one.template operator()<2, 2>();
    one.template operator()<2, 3>(), one.template operator()<3, 0>(), one.template operator()<3, 1>(), one.template operator()<3, 2>();
  }

  void add_axis(Index j, model::Axis axis) {
    const model::Joint& joint = model_.joints[std::size_t(j)];
    axis.reference = joint.reference;
    if (!is_looking_) {
      loop_.world().resolve(axis.a, "add"), loop_.world().resolve(axis.b, "add");
      machine_.axes[std::size_t(j)] = axis;
      machine_.axes[std::size_t(j)].zero = axis.zero = axis.sign * (position_of(loop_.world(), machine_, j) - axis.reference);
    }
    machine_.axes[std::size_t(j)] = axis;
    switch (axis.kind) {
      case model::AxisKind::turn: add_laws<Turn>("Turn", joint, axis); break;
      case model::AxisKind::slide: add_laws<Slide>("Slide", joint, axis); break;
      case model::AxisKind::precession: add_laws<Precession>("Precession", joint, axis); break;
      case model::AxisKind::nutation: add_laws<Nutation>("Nutation", joint, axis); break;
      case model::AxisKind::spin: add_laws<Spin>("Spin", joint, axis); break;
      case model::AxisKind::length: break;  // of tendons alone
    }
  }

  /// What acts on one axis.
  template <class C>
  void add_laws(const std::string& name, const model::Joint& joint, const model::Axis& axis) {
    if (joint.is_limited && !leave_out_.limits)
      emit<Limit<C>>(("Limit<" + name + ">{}").c_str(), [&] {
        const double one = axis.coordinate(joint.lower), other = axis.coordinate(joint.upper);
        return typename Limit<C>::Item{.a = axis.a, .b = axis.b, .lower = std::min(one, other), .upper = std::max(one, other), .position = axis.zero};
      });
    const double stiffness = leave_out_.springs ? 0 : joint.stiffness, damping = leave_out_.damping ? 0 : joint.damping;
    if (stiffness > 0 || damping > 0)
      emit<SpringDamper<C>>(("SpringDamper<" + name + ">{}").c_str(), [&] {
        return typename SpringDamper<C>::Item{.a = axis.a, .b = axis.b, .rest = axis.coordinate(joint.spring_reference), .stiffness = stiffness, .damping = damping, .position = axis.zero};
      });
    if (joint.armature > 0 && !leave_out_.rotors)
      emit<RotorInertia<C>>(("RotorInertia<" + name + ">{}").c_str(), [&] { return typename RotorInertia<C>::Item{.a = axis.a, .b = axis.b, .inertia = joint.armature}; });
    if (joint.friction_loss > 0 && !leave_out_.friction_loss)
      emit<Motor<C>>(("Motor<" + name + ">{}").c_str(), [&] {
        return typename Motor<C>::Item{.a = axis.a, .b = axis.b, .max_force = joint.friction_loss, .position = axis.zero};
      });
  }

  // --- what closes loops ---------------------------------------------------------------------------------------

  void add_couplings() {
    for (const model::Coupling& coupling : model_.couplings) add_coupling(coupling);
    for (const model::Connect& connect : model_.connects) {
      if (moves_as_one(connect.body, connect.other)) {
        leave("connect '" + connect.name + "' has nothing to hold: its two bodies move as one");
        continue;
      }
      const Vec3 point = world(connect.body).to_world(connect.point), other = world(connect.other).to_world(connect.other_point);
      emit<BallJoint>("BallJoint{}", [&] { return BallJoint::Item{end(connect.body, point, Quat::Identity()), end(connect.other, other, Quat::Identity())}; });
    }
    for (const model::Weld& weld : model_.welds) {
      if (moves_as_one(weld.body, weld.other)) {
        leave("weld '" + weld.name + "' has nothing to hold: its two bodies move as one");
        continue;
      }
      const Pose one = world(weld.body), there = Lumps::in(one, weld.pose), other = world(weld.other);
      emit<delassus::Weld>("Weld{}", [&] {
        return delassus::Weld::Item{end(weld.body, there.position, Quat(there.rotation)), end(weld.other, other.position, Quat(other.rotation))};
      });
    }
  }
  void add_coupling(const model::Coupling& coupling) {
    const auto& c = coupling.coefficients;
    const auto kind = [&](Index j) { return machine_.axes[std::size_t(j)].kind; };
    const auto is_simple = [&](Index j) { return j >= 0 && (kind(j) == model::AxisKind::turn || kind(j) == model::AxisKind::slide) && model_.joints[std::size_t(j)].kind != model::JointKind::ball; };
    if (c[2] != 0 || c[3] != 0 || c[4] != 0) return leave("coupling '" + coupling.name + "' does not act: it is not linear");
    if (coupling.of_tendons || !is_simple(coupling.joint) || !is_simple(coupling.other) || owner(coupling.joint) == owner(coupling.other))
      return couple_lengths(*this, coupling);
    const bool first_turns = kind(coupling.joint) == model::AxisKind::turn, second_turns = kind(coupling.other) == model::AxisKind::turn;
    if (first_turns && second_turns) emit_coupling<Turn, Turn>("Coupling<Turn, Turn>{}", coupling);
    else if (first_turns) emit_coupling<Turn, Slide>("Coupling<Turn, Slide>{}", coupling);
    else if (second_turns) emit_coupling<Slide, Turn>("Coupling<Slide, Turn>{}", coupling);
    else emit_coupling<Slide, Slide>("Coupling<Slide, Slide>{}", coupling);
  }
  template <class A, class B>
  void emit_coupling(const char* name, const model::Coupling& coupling) {
    const model::Axis &one = machine_.axes[std::size_t(coupling.joint)], &other = machine_.axes[std::size_t(coupling.other)];
    emit<Coupling<A, B>>(name, [&] {
      const double ratio = one.sign * other.sign * coupling.coefficients[1];
      return typename Coupling<A, B>::Item{.a = one.b, .b = other.b, .c = one.a, .d = other.a, .ratio = ratio,
                                           .phase = one.zero + one.sign * coupling.coefficients[0] - ratio * other.zero,
                                           .position_a = one.zero, .position_b = other.zero};
    });
  }

  /// The excludes, and what hangs on a link that the world holds: a joint to the world names no body that a filter could ask for.
  void add_exclusions() {
    if (leave_out_.contacts || !model_.contacts) return;
    if constexpr (collides) exclude();
  }
  void exclude() {
    auto* filter = filter_layer(loop_.data().template policy<role::Collision>(), loop_.world());
    if constexpr (std::is_same_v<decltype(filter), int*>) {
      if (!model_.excludes.empty()) miss("WithFilter{...}");
    } else if (!is_looking_) {
      for (const model::Exclude& pair : model_.excludes) ignore(*filter, pair.body, pair.other);
      if (model_.parents_collide) return;
      for (const Chain& chain : chains_) {
        const Index parent = model_.bodies[std::size_t(chain.body)].parent;
        if (parent < 0 || !machine_.parts[std::size_t(parent)].is_world) continue;
        for (const Still& still : still_)
          if (still.link >= 0 && root_of(still.link) == root_of(parent)) ignore(*filter, chain.body, still.link);
      }
    }
  }
  void ignore(auto& filter, Index one, Index other) const {
    const bool is_one_still = is_in_world(one), is_other_still = is_in_world(other);
    if (is_one_still && is_other_still) return;
    if (is_one_still) return ignore(filter, other, one);
    const RigidBodies::Handle body = machine_.parts[std::size_t(one)].body;
    if (!is_other_still) {
      const RigidBodies::Handle against = machine_.parts[std::size_t(other)].body;
      if (body.index != against.index) filter.ignore(loop_.world(), anchor(set_, body), anchor(set_, against));
      return;
    }
    for (const Still& still : still_)
      if (still.link == other) filter.ignore(loop_.world(), anchor(set_, body), anchor(set_, still.body));
  }
  bool is_in_world(Index body) const { return body < 0 || lumps_.of[std::size_t(body)] == 0; }
  Index root_of(Index body) const {
    while (model_.bodies[std::size_t(body)].parent >= 0) body = model_.bodies[std::size_t(body)].parent;
    return body;
  }

  Loop& loop_;
  RigidBodies& set_;
  const Model& model_;
  const Lumps& lumps_;
  const Pose pose_;
  const LeaveOut& leave_out_;
  ModelShapes shapes_;
  std::vector<Pose> world_pose_;  ///< by body, in the pose that the tree describes
  struct Still {
    Index link;  ///< −1: the world's own
    RigidBodies::Handle body;
  };
  std::vector<Still> still_;      ///< the shapes that stand in the world
  std::vector<Chain> chains_;     ///< of the lumps that move, in their order
  std::vector<std::string> missing_;
  Machine machine_;
  bool is_looking_ = false;  ///< for what is missing: nothing is added
};

}  // namespace delassus::inner
