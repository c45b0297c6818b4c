/// A machine in a loop of some type, as the rest of delassus_run sees it: the types of loops are compiled in files of their own.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/model/joint_reader.hpp>
#include <delassus/model/machine.hpp>
#include <delassus/schemes/error_report.hpp>
#include <delassus/step/contact_result.hpp>
#include <delassus/step/step_report.hpp>
#include <delassus/study/audit_report.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace delassus_run {

using namespace delassus;

/// Who makes a step.
enum class Integration { euler, midpoint };

/// Of contacts whose shapes say none.
inline constexpr double usual_friction = 0.8;

/// Which loop, and its numbers.
struct Asked {
  Integration integration = Integration::euler;
  double accuracy = 0;  ///< of `ErrorControlled`; 0: the steps are as the caller says
  bool audits = false;
  double tolerance = 1e-6;
  double friction = -1;  ///< of all contacts; negative: as the shapes say
  double longest_step = 0.1;  ///< that the caller makes, s
  int threads = 1;            ///< of a step; 0: one a processor
};

/// Has what the rest asks of a loop, one virtual call each a step.
class Motion {
 public:
  using EachJoint = std::function<void(const Anchor&, const Anchor&)>;

  Machine machine;
  std::vector<double> joints;  ///< of each joint: q of a hinge or slide as the run begins, with all its turns, rad or m

  virtual ~Motion() = default;
  /// The machine's controls hold for h s.
  virtual StepReport step(double h) = 0;
  virtual World<RigidBodies>& world() = 0;
  virtual double time() const = 0;
  /// As `set_joint_state`.
  virtual void set_joints(JointSpace& space, std::span<const double> q, std::span<const double> v) = 0;
  virtual void read_joints(JointReader& reader, std::span<double> q, std::span<double> v) const = 0;
  virtual std::span<const ContactResult> contacts() const = 0;
  virtual void each_joint(const EachJoint& f) const = 0;
  /// Of the steps so far, where `Asked::audits`; joints have the names of the links that they hold.
  virtual AuditReport audit() const = 0;
  /// Of the last step; nothing where its size is the caller's.
  virtual ErrorReport error_report() const = 0;

  const World<RigidBodies>& world() const { return const_cast<Motion&>(*this).world(); }
  RigidBodies& set() { return bodies<RigidBodies>(world()); }
  const RigidBodies& set() const { return bodies<RigidBodies>(world()); }
};

/// The loop that the model and the options ask for, with the model in it. Refuses as `add` does.
std::unique_ptr<Motion> moved(const Model& model, const Pose& pose, Base base, const Asked& asked);

/// A sentence that says which one it is.
std::string name_of(const Model& model, const Asked& asked);

}  // namespace delassus_run
