/// The numbers of a machine's joints, read from the bodies of its loop.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/model/inner/each_rotor.hpp>
#include <delassus/model/joint_space.hpp>
#include <delassus/model/machine.hpp>
#include <delassus/model/model.hpp>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace delassus {

/// Reads q and v of all joints, as `JointSpace` numbers them. `set_joint_state` with what was read goes on with the same motion:
/// v has the momentum of the bodies. A step holds joints where they are as it starts. As they turn, the bodies end with rates that
/// no v has, and the rates between them alone would miss the Coriolis acceleration of that step.
///
/// After the first call none allocates. Not for two threads at once.
class JointReader {
 public:
  /// Takes what the machine was added with. `model` is kept by reference.
  explicit JointReader(const Model& model, Base base = Base::as_file, const Pose& pose = {})
      : model_(model), space_(model, base, pose), poses_(model.bodies.size()), velocities_(poses_.size()), moved_(poses_.size()),
        momentum_(std::size_t(space_.v_size())), at_rest_(momentum_.size(), 0), columns_(momentum_.size()) {}

  /// Where the joints are. q has the last numbers, or `JointSpace::reference`: an angle goes on from there by whole turns.
  void read_q(const RigidBodies& set, const Machine& machine, std::span<double> q) {
    DELASSUS_EXPECT(machine.parts.size() == poses_.size(),
                    "JointReader: the machine has " + std::to_string(machine.parts.size()) + " links and the model " +
                        std::to_string(poses_.size()) + "; give the machine that was made of the model");
    for (std::size_t b = 0; b < poses_.size(); ++b) {
      poses_[b] = pose_of(set, machine, Index(b));
      space_.read_q(Index(b), above(b, poses_, Pose{}), poses_[b], q);
    }
  }

  /// And how they move. Where a freedom has no inertia of its own (`JointSpace::forward_dynamics`), v are the rates between bodies.
  template <class Loop>
  void read(const Loop& loop, const Machine& machine, std::span<double> q, std::span<double> v) {
    const RigidBodies& set = bodies<RigidBodies>(loop.world());
    read_q(set, machine, q);
    read_rates(set, machine, q, v);
    for (double& p : momentum_) p = 0;
    inner::each_rotor(loop, machine, [&](Index j, const auto& item) {
      const Index k = space_.v_of(j);
      if (k >= 0 && !std::isnan(item.rate))
        momentum_[std::size_t(k)] = item.inertia * (machine.axes[std::size_t(j)].sign * item.rate - v[std::size_t(k)]);
    });
    take_momentum(q, v);
  }

  /// Of the frame of each link in the world, when it was last read.
  std::span<const Pose> poses() const { return poses_; }
  /// Likewise: the velocity of its origin, and the angular velocity; see `math/twist.hpp`.
  std::span<const Vec<6>> velocities() const { return velocities_; }
  JointSpace& space() { return space_; }  ///< that of the model

 private:
  template <class T>
  T above(std::size_t body, const std::vector<T>& all, const T& root) const {
    const Index parent = model_.bodies[body].parent;
    return parent < 0 ? root : all[std::size_t(parent)];
  }

  /// Between the bodies.
  void read_rates(const RigidBodies& set, const Machine& machine, std::span<const double> q, std::span<double> v) {
    for (std::size_t b = 0; b < poses_.size(); ++b) {
      const model::Part& part = machine.parts[b];
      velocities_[b] = zero<Vec<6>>();
      if (!part.is_world) {
        const Vec3 spin = set.angular_velocity(part.body);
        const Vec3 arm = poses_[b].position - set.position(part.body);
        velocities_[b] = carried(twist<double>(set.velocity(part.body), spin), arm);
      }
      space_.read_v(Index(b), q, above(b, poses_, Pose{}), poses_[b], above(b, velocities_, zero<Vec<6>>()), velocities_[b], v);
    }
  }

  /// v ← v + H⁻¹ (p + Σ Jᵀ M r), r what the bodies move beside the rates v, p the same of rotors.
  void take_momentum(std::span<const double> q, std::span<double> v) {
    if (v.empty()) return;
    space_.velocities(q, v, moved_);
    for (std::size_t b = 0; b < poses_.size(); ++b) {
      const model::Body& body = model_.bodies[b];
      if (body.mass == 0) continue;
      std::size_t root = b;
      while (model_.bodies[root].parent >= 0) root = std::size_t(model_.bodies[root].parent);
      Vec<6> beside = velocities_[b] - moved_[b];
      if (model_.bodies[root].is_kinematic) beside -= carried(velocities_[root], Vec3(poses_[b].position - poses_[root].position));
      const Vec3 turn = angular_part(beside), arm = poses_[b].rotation * body.centre;
      const Vec3 linear = body.mass * Vec3(linear_part(beside) + cross(turn, arm));
      const Vec3 angular = poses_[b].rotation * Vec3(body.inertia * transposed_times(poses_[b].rotation, turn));
      space_.jacobian(q, Index(b), body.centre, columns_);
      for (std::size_t k = 0; k < columns_.size(); ++k)
        momentum_[k] += dot(linear_part(columns_[k]), linear) + dot(angular_part(columns_[k]), angular);
    }
    try {
      space_.forward_dynamics(q, at_rest_, momentum_, momentum_, {.gravity = false, .gravity_compensation = false, .springs = false, .damping = false});
    } catch (const InvalidArgument&) {
      return;
    }
    for (std::size_t k = 0; k < v.size(); ++k) v[k] += momentum_[k];
  }

  static Vec<6> carried(const Vec<6>& velocity, const Vec3& arm) {
    const Vec3 spin = angular_part(velocity);
    return twist<double>(Vec3(linear_part(velocity) + cross(spin, arm)), spin);
  }

  const Model& model_;
  JointSpace space_;
  std::vector<Pose> poses_;
  std::vector<Vec<6>> velocities_, moved_;  ///< of the links; what v makes of them
  std::vector<double> momentum_, at_rest_;
  std::vector<Vec<6>> columns_;  ///< of a Jacobian
};

}  // namespace delassus
