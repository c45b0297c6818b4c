/// A machine in a loop of one type, as a Motion.
#pragma once

#include "loop_of.hpp"  // before all else

#include "machine_in.hpp"

namespace delassus_run {

/// `make` returns the loop that is asked for.
template <auto make>
class InLoop final : public Motion {
 public:
  using Loop = decltype(make(Asked{}));

  InLoop(const Model& model, const Pose& pose, Base base, const Asked& asked) : loop_(make(asked)) {
    set().gravity = model.gravity;
    machine = MachineIn<Loop>::put(loop_, model, pose, base, asked.friction >= 0);
    for (const model::Body& body : model.bodies) {
      names_.links.push_back("'" + body.name + "'");
      names_.joints.push_back(body.joints.size() == 1 ? "joint '" + model.joints[std::size_t(body.joints[0])].name + "'" : "link " + names_.links.back());
    }
  }

  StepReport step(double h) override {
    if (!machine.actuators.empty() || !machine.lifts.empty()) MachineIn<Loop>::drive(loop_, machine, h);
    return loop_.step(h);
  }
  World<RigidBodies>& world() override { return loop_.world(); }
  double time() const override { return loop_.time(); }
  void set_joints(JointSpace& space, std::span<const double> q, std::span<const double> v) override { MachineIn<Loop>::place(loop_, machine, space, q, v); }
  void read_joints(JointReader& reader, std::span<double> q, std::span<double> v) const override { MachineIn<Loop>::read(loop_, machine, reader, q, v); }
  std::span<const ContactResult> contacts() const override { return loop_.contacts(); }
  void each_joint(const EachJoint& f) const override {
    loop_.each_joint([&](const Anchor& a, const Anchor& b) { f(a, b); });
  }
  AuditReport audit() const override { return MachineIn<Loop>::audit(loop_, machine, names_); }
  ErrorReport error_report() const override {
    if constexpr (requires { loop_.data().template state<role::Scheme>().report(); }) return loop_.data().template state<role::Scheme>().report();
    else return {};
  }

 private:
  Loop loop_;
  Names names_;
};

}  // namespace delassus_run
