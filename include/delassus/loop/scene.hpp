/// What a loop holds apart from how it steps.
#pragma once

#include <delassus/constraints/contact/materials.hpp>
#include <delassus/constraints/pool.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/loop/edit.hpp>

#include <type_traits>

namespace delassus {

/// World, laws and collision of a loop, under the names that the loop has for them. Functions that put something there or read it
/// (`add` of a model, `actuate`, `set_joint_state`, `JointReader::read`) take a scene in the place of a loop. Loops that differ in
/// integrator, solver or scheme have one type of scene, so that a program compiles such functions once for all of them. It refers to
/// the loop, which stays where it is as long as the scene is used, and it wakes no body.
template <class World, class Laws_, class Collision, class Materials_>
class Scene {
 public:
  using Laws = Laws_;

  template <class Data>
  explicit Scene(Data& data) : world_(data.world()), laws_(data.laws()), is_under_way_(data.is_under_way) {
    if constexpr (Laws::has_contacts) {
      collision_ = &data.template policy<role::Collision>();
      materials_ = &data.material_pairs;
    }
  }

  World& world() const { return world_; }
  Laws& laws() const { return laws_; }
  /// The scene again, which has names of `StepData` as well.
  const Scene& data() const { return *this; }
  /// Of `role::Collision` alone.
  template <class Role>
  auto& policy() const {
    static_assert(std::is_same_v<Role, role::Collision>, "delassus: a Scene has no other policy than that of the collision; ask the loop");
    return *collision_;
  }
  auto& materials() const
    requires(Laws::has_contacts)
  {
    return *materials_;
  }

  /// As `AnimationLoop::add`.
  template <class Item>
  auto add(Item item) const {
    return inner::add_constraint<true>(world_, laws_, is_under_way_, item);
  }
  template <class Law>
  bool contains(ConstraintHandle<Law> constraint) const {
    return laws_.template of<Law>().contains(constraint);
  }
  template <class Law>
  auto& item(ConstraintHandle<Law> constraint) const {
    return laws_.template of<Law>().item_of(constraint);
  }

 private:
  World& world_;
  Laws& laws_;
  Collision* collision_ = nullptr;
  Materials_* materials_ = nullptr;
  const bool& is_under_way_;
};

/// Of a loop.
template <class Loop>
auto scene_of(Loop& loop) {
  auto& data = loop.data();
  using World = std::remove_reference_t<decltype(data.world())>;
  using Laws = std::remove_reference_t<decltype(data.laws())>;
  if constexpr (Laws::has_contacts) {
    using Collision = std::remove_reference_t<decltype(data.template policy<role::Collision>())>;
    return Scene<World, Laws, Collision, std::conditional_t<std::is_const_v<Loop>, const Materials, Materials>>(data);
  } else {
    return Scene<World, Laws, void, void>(data);
  }
}

}  // namespace delassus
