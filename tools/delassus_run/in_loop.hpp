/// A machine in a loop of one type. For the files that compile the types.
#pragma once

#include "shared_laws.hpp"  // before all else

#include "motion.hpp"
#include "program_threads.hpp"

#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/study/audit.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace delassus_run {

/// An Audit that sleeps unless it is asked for.
struct AuditWhereAsked {
  using plays = role::Listener;
  using listens = Audit::listens;
  Audit audit;
  bool is_asked = false;

  template <class Stage>
  void after(Stage stage, const auto& loop) {
    if (is_asked) audit.after(stage, loop);
  }
};

template <class Loop>
class InLoop final : public Motion {
 public:
  template <class... Parts>
  explicit InLoop(const Model& model, const Pose& pose, Base base, bool has_one_friction, Parts... parts) : loop_(World{RigidBodies{}}, std::move(parts)...) {
    set().gravity = model.gravity;
    machine = add(loop_, model, pose, base, LeaveOut{.surfaces = has_one_friction});
    for (const model::Body& body : model.bodies) links_.push_back(body.name);
  }

  StepReport step(double h) override {
    if (!machine.actuators.empty()) actuate(loop_, machine, h);
    return loop_.step(h);
  }
  World<RigidBodies>& world() override { return loop_.world(); }
  double time() const override { return loop_.time(); }
  std::span<const ContactResult> contacts() const override { return loop_.contacts(); }
  void each_joint(const EachJoint& f) const override {
    loop_.each_joint([&](const Anchor& a, const Anchor& b) { f(a, b); });
  }
  AuditReport audit() const override {
    AuditReport report = loop_.template get<AuditWhereAsked>().audit.report();
    each_pool(loop_.data().laws(), [&](auto, const auto& pool) {
      const std::string law = inner::type_text<std::remove_cvref_t<decltype(pool.law)>>();
      if constexpr (requires { pool.slots; pool.item(0).a; })
        for (EffectUse& use : report.uses)
          if (use.effect == Effect::joint && use.name == law)
            for (Index i = 0; i < pool.count(); ++i)
              if (int(pool.slots.active()[std::size_t(i)]) == use.place) use.name += " of " + link_of(pool.item(i).b, pool.item(i).a);
    });
    for (EffectUse& use : report.uses)
      for (std::size_t b = 0; use.effect == Effect::body && b < machine.parts.size(); ++b)
        if (!machine.parts[b].is_world && use.name == set().who(machine.parts[b].body.index)) {
          use.name = "'" + links_[b] + "'";
          break;
        }
    return report;
  }
  ErrorReport error_report() const override {
    if constexpr (requires { loop_.data().template state<role::Scheme>().report(); }) return loop_.data().template state<role::Scheme>().report();
    else return {};
  }

 private:
  /// The link at an end, or at the other where that is in the world.
  std::string link_of(const Anchor& end, const Anchor& other) const {
    for (const Anchor& anchor : {end, other})
      for (std::size_t b = 0; b < machine.parts.size() && !anchor.is_world(); ++b)
        if (!machine.parts[b].is_world && machine.parts[b].body.index == anchor.block) return "'" + links_[b] + "'";
    return "the world";
  }

  Loop loop_;
  std::vector<std::string> links_;  ///< names
};

/// In a loop of these laws and parts, and of what all types have.
template <class Laws, class... Parts>
std::unique_ptr<Motion> in_loop(const Model& model, const Pose& pose, Base base, const Asked& asked, Laws laws, Parts... parts) {
  const auto make = [&](auto... all) {
    using Loop = decltype(AnimationLoop{World{RigidBodies{}}, all...});
    return std::make_unique<InLoop<Loop>>(model, pose, base, asked.friction >= 0, std::move(all)...);
  };
  return make(std::move(laws), WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = asked.tolerance},
              AuditWhereAsked{.audit = {}, .is_asked = asked.audits}, program_threads(asked.threads), std::move(parts)...);
}

/// Of contacts with what has no surface of its own.
inline double friction_of(const Asked& asked) { return asked.friction >= 0 ? asked.friction : usual_friction; }

/// Every law that a machine of a file may need.
inline auto every_law(const Asked& asked) {
  return Constraints{Contact{Coulomb{.friction = friction_of(asked)}}, Hinge{}, Slider{}, BallJoint{}, Weld{}, SerialJoint<0, 2>{}, SerialJoint<0, 3>{},
                     SerialJoint<1, 1>{}, SerialJoint<2, 0>{}, SerialJoint<2, 1>{}, SerialJoint<3, 0>{}, Limit<Turn>{}, Limit<Slide>{},
                     Limit<Precession>{}, Limit<Nutation>{}, Limit<Spin>{}, Limit<Length>{}, SpringDamper<Turn>{}, SpringDamper<Slide>{},
                     SpringDamper<Precession>{}, SpringDamper<Nutation>{}, SpringDamper<Spin>{}, SpringDamper<Length>{}, RotorInertia<Turn>{},
                     RotorInertia<Slide>{}, RotorInertia<Precession>{}, RotorInertia<Nutation>{}, RotorInertia<Spin>{}, Motor<Turn>{},
                     Motor<Slide>{}, Motor<Precession>{}, Motor<Nutation>{}, Motor<Spin>{}, Coupling<Turn, Turn>{}, Coupling<Slide, Turn>{},
                     Coupling<Turn, Slide>{}, Coupling<Slide, Slide>{}, Motor<Length>{}, Drive<Turn>{}, Drive<Slide>{},
                     Drive<Precession>{}, Drive<Nutation>{}, Drive<Spin>{}, Drive<Length>{}, Limit<RotationAngle>{}, Tendon<3>{}, TendonLimit<3>{},
                     TendonMotor<3>{}};
}
/// Those of links with one axis each, which most robots have.
inline auto laws_of_single_axes(const Asked& asked) {
  return Constraints{Contact{Coulomb{.friction = friction_of(asked)}}, Hinge{}, Slider{}, Limit<Turn>{}, Limit<Slide>{}, SpringDamper<Turn>{},
                     SpringDamper<Slide>{}, RotorInertia<Turn>{}, RotorInertia<Slide>{}, Motor<Turn>{}, Motor<Slide>{}, Drive<Turn>{}, Drive<Slide>{}};
}

}  // namespace delassus_run
