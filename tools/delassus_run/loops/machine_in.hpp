/// What touches every law of a loop with a machine in it. It takes the compiler as much as the steps do, so each type of loops has it
/// in a file of its own, apart from its steps: <type>_machine.cpp defines it from define_machine_in.hpp.
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

template <class Loop>
struct MachineIn {
  static Machine put(Loop& loop, const Model& model, const Pose& pose, Base base, bool has_one_friction);
  /// As `actuate`.
  static void drive(Loop& loop, Machine& machine, double h);
  /// As `set_joint_state`.
  static void place(Loop& loop, Machine& machine, JointSpace& space, std::span<const double> q, std::span<const double> v);
  static void read(const Loop& loop, const Machine& machine, JointReader& reader, std::span<double> q, std::span<double> v);
  /// With the names of joints and links in place of numbers.
  static AuditReport audit(const Loop& loop, const Machine& machine, const Names& names);
};

}  // namespace delassus_run
