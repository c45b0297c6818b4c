/// What the parts of `add` share: the model, the loop, the machine so far, and what the loop lacks.
#pragma once

#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/model/inner/add_shapes.hpp>
#include <delassus/model/inner/chains.hpp>
#include <delassus/model/inner/contact_kinds.hpp>
#include <delassus/model/inner/surface_kinds.hpp>
#include <delassus/model/machine.hpp>

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

namespace delassus::inner {

/// A shape of a link that stands in the world.
struct Still {
  Index link;  ///< −1: the world's own
  RigidBodies::Handle body;
};

/// At first it looks on: nothing is added, and what would be refused is refused. Then it builds the same.
template <class Loop>
class MachineBuilder {
 public:
  using Laws = typename Loop::Laws;
  static constexpr bool collides = Laws::has_contacts;
  template <class Law>
  static constexpr bool names = !std::is_void_v<typename Laws::template law_of<typename Law::Item>::type>;

  MachineBuilder(Loop& loop, const Model& model, const Lumps& lumps, const Pose& pose,
                 const LeaveOut& leave_out)
      : loop_(loop),
        set_(bodies<RigidBodies>(loop.world())),
        model_(model),
        lumps_(lumps),
        pose_(pose),
        leave_out_(leave_out),
        shapes_(model),
        contact_kinds_(model),
        surface_kinds_(model) {
    world_pose_.resize(model.bodies.size());
    owner_.assign(model.joints.size(), -1);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      const Index parent = model.bodies[b].parent;
      world_pose_[b] = Lumps::in(world(parent), model.bodies[b].pose);
      for (const Index j : model.bodies[b].joints) owner_[std::size_t(j)] = Index(b);
    }
    for (std::size_t l = 1; l < lumps.all.size(); ++l)
      chains_.push_back(chain_of(model, lumps.all[l].root, world(lumps.all[l].root)));
  }

  Loop& loop() { return loop_; }
  RigidBodies& set() { return set_; }
  auto& backend() { return loop_.data().template policy<role::Collision>(); }
  const Model& model() const { return model_; }
  const Lumps& lumps() const { return lumps_; }
  const Pose& pose() const { return pose_; }
  const LeaveOut& leave_out() const { return leave_out_; }
  ModelShapes& shapes() { return shapes_; }
  ContactKinds& contact_kinds() { return contact_kinds_; }
  SurfaceKinds& surface_kinds() { return surface_kinds_; }
  const std::vector<Chain>& chains() const { return chains_; }  ///< of the lumps that move, in their order
  std::vector<Still>& still() { return still_; }                ///< the shapes that stand in the world
  Machine& machine() { return machine_; }
  bool is_looking() const { return is_looking_; }
  /// Whether shapes of the model may meet at all.
  bool has_contacts() const { return !leave_out_.contacts && model_.contacts; }

  /// From now on things are added. Refuses, in one sentence, all laws and layers that the loop does not name.
  void stop_looking() {
    is_looking_ = false;
    machine_ = {};
    contact_kinds_.number(set_);
    if (missing_.empty()) return;
    std::string list;
    for (const std::string& law : missing_) list += (list.empty() ? "" : ", ") + law;
    refuse("add: model '" + model_.name + "' needs what this loop does not name: " + list +
           "; add it to Constraints{...} or to the collision of the loop, or leave it out by LeaveOut");
  }

  /// Adds the item of a law that the loop names, or notes the law. Looking on, the law checks an item between
  /// ends in the world; what it refuses is said of `kind` `name`.
  template <class Law, class MakeItem>
  model::ConstraintNumber emit(const char* law, const MakeItem& item) {
    if constexpr (names<Law>) {
      if (!is_looking_) {
        const auto handle = loop_.add(item());
        return {handle.index, handle.generation, handle.owner};
      }
      checked([&] { who_refines<refine::check>(loop_.data().laws().template of<Law>().law).check(item()); });
    } else {
      miss(law);
    }
    return {};
  }
  /// f(), which may refuse: of what was last named by `speak_of`.
  template <class F>
  void checked(const F& f) const {
    try {
      f();
    } catch (const InvalidArgument& why) {
      refuse("add: model '" + model_.name + "': " + topic_ + ": " + std::string(why.what()).substr(10));
    }
  }
  void speak_of(const char* kind, const std::string& name) { topic_ = std::string(kind) + " '" + name + "'"; }
  void miss(const std::string& name) {
    if (std::find(missing_.begin(), missing_.end(), name) == missing_.end()) missing_.push_back(name);
  }
  void leave(const std::string& sentence) {
    machine_.left_out.push_back("model '" + model_.name + "': " + sentence);
  }

  Index lump(Index body) const { return body < 0 ? 0 : lumps_.of[std::size_t(body)]; }
  bool moves_as_one(Index a, Index b) const { return lump(a) == lump(b); }
  bool is_in_world(Index body) const { return lump(body) == 0; }
  /// Of a body, in the pose that the tree describes.
  Pose world(Index body) const { return body < 0 ? pose_ : world_pose_[std::size_t(body)]; }
  Index owner(Index joint) const { return owner_[std::size_t(joint)]; }
  /// Whether the machine has the joint, and nothing holds it.
  bool moves(Index joint) const {
    const Index body = owner(joint);
    if (body < 0 || model_.bodies[std::size_t(body)].is_kinematic) return false;
    return lump(body) > 0 && lumps_.all[std::size_t(lump(body))].root == body;
  }
  Vec3 site(Index s) const {
    const model::Site& site = model_.sites[std::size_t(s)];
    return world(site.body).to_world(site.pose.position);
  }
  /// The end of a joint on a body of the model, at a place of the world in the pose of the tree.
  Anchor end(Index body, const Vec3& point, const Quat& frame = Quat::Identity()) const {
    if (is_looking_ || body < 0 || machine_.parts[std::size_t(body)].is_world)
      return world_anchor(point, frame);
    return anchor_at(set_, machine_.parts[std::size_t(body)].body, point, frame);
  }
  /// Between two ends, in the pose of the tree.
  double distance(const Anchor& a, const Anchor& b) const {
    return norm(Vec3(loop_.world().point(a) - loop_.world().point(b)));
  }
  /// As the loop knows it.
  Anchor resolved(Anchor end) const {
    if (!is_looking_) loop_.world().resolve(end, "add");
    return end;
  }

 private:
  Loop& loop_;
  RigidBodies& set_;
  const Model& model_;
  const Lumps& lumps_;
  const Pose pose_;
  const LeaveOut& leave_out_;
  ModelShapes shapes_;
  ContactKinds contact_kinds_;
  SurfaceKinds surface_kinds_;
  std::vector<Pose> world_pose_;  ///< by body, in the pose that the tree describes
  std::vector<Index> owner_;      ///< by joint
  std::vector<Still> still_;
  std::vector<Chain> chains_;
  std::vector<std::string> missing_;
  std::string topic_ = "it";
  Machine machine_;
  bool is_looking_ = true;
};

}  // namespace delassus::inner
