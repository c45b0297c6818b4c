/// A machine in a loop of one type, as a Motion.
#pragma once

#include "loop_of.hpp"  // before all else

#include "machine_in.hpp"

#include <delassus/loop/scene.hpp>

#include <utility>

namespace delassus_run {

/// `make` returns the loop that is asked for.
template <auto make>
class InLoop final : public Motion {
 public:
  using Loop = decltype(make(Asked{}));
  using In = MachineIn<decltype(scene_of(std::declval<Loop&>()))>;

  InLoop(const Model& model, const Pose& pose, Base base, const Asked& asked) : loop_(make(asked)) {
    set().gravity = model.gravity;
    machine = In::put(scene(), model, pose, base, asked.friction >= 0);
    for (const model::Body& body : model.bodies) {
      names_.links.push_back("'" + body.name + "'");
      names_.joints.push_back(body.joints.size() == 1 ? "joint '" + model.joints[std::size_t(body.joints[0])].name + "'" : "link " + names_.links.back());
    }
  }

  StepReport step(double h) override {
    if (!machine.actuators.empty() || !machine.lifts.empty()) In::drive(scene(), machine, h);
    return loop_.step(h);
  }
  World<RigidBodies>& world() override { return loop_.world(); }
  double time() const override { return loop_.time(); }
  void set_joints(JointSpace& space, std::span<const double> q, std::span<const double> v) override { In::place(scene(), machine, space, q, v); }
  void read_joints(JointReader& reader, std::span<double> q, std::span<double> v) const override { In::read(scene(), machine, reader, q, v); }
  std::span<const ContactResult> contacts() const override { return loop_.contacts(); }
  void each_joint(const EachJoint& f) const override {
    loop_.each_joint([&](const Anchor& a, const Anchor& b) { f(a, b); });
  }
  AuditReport audit() const override {
    AuditReport report = loop_.template get<AuditWhereAsked>().audit.report();
    In::name_uses(scene(), machine, names_, report);
    return report;
  }
  ErrorReport error_report() const override {
    if constexpr (requires { loop_.data().template state<role::Scheme>().report(); }) return loop_.data().template state<role::Scheme>().report();
    else return {};
  }

 private:
  auto scene() const { return scene_of(const_cast<Loop&>(loop_)); }  // nothing is written there by who only reads

  Loop loop_;
  Names names_;
};

}  // namespace delassus_run
