/// What touches every law of a loop with a machine in it. It takes the compiler as much as the steps do, and loops with the same laws
/// have it from one file: machine_in_<laws>.cpp defines it from define_machine_in.hpp.
#pragma once

#include "../motion.hpp"

#include <span>
#include <string>
#include <vector>

namespace delassus_run {

/// Links in words.
struct Names {
  std::vector<std::string> links, joints;  ///< of each link: itself; its joint, or itself where it has none or several
};

template <class Scene>
struct MachineIn {
  static Machine put(const Scene& scene, const Model& model, const Pose& pose, Base base, bool has_one_friction);
  /// As `actuate`.
  static void drive(const Scene& scene, Machine& machine, double h);
  /// As `set_joint_state`.
  static void place(const Scene& scene, Machine& machine, JointSpace& space, std::span<const double> q, std::span<const double> v);
  static void read(const Scene& scene, const Machine& machine, JointReader& reader, std::span<double> q, std::span<double> v);
  /// Names joints and links in place of numbers.
  static void name_uses(const Scene& scene, const Machine& machine, const Names& names, AuditReport& report);
};

}  // namespace delassus_run
