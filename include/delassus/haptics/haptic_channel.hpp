/// Force feedback: a thread of its own solves the tool's island anew, a thousand times a second, where the device is now.
#pragma once

#include <delassus/constraints/joints/virtual_coupling.hpp>
#include <delassus/core/clock.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/haptics/device_state.hpp>
#include <delassus/haptics/force_output.hpp>
#include <delassus/haptics/tool_rows.hpp>
#include <delassus/listeners/double_buffer.hpp>
#include <delassus/listeners/triple_buffer.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/with_deadline.hpp>
#include <delassus/step/channels.hpp>
#include <delassus/step/stage.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace delassus {

/// The tool is a body of the loop, tied by a `VirtualCoupling` to a kinematic body that stands for the device. After each
/// solve the loop's thread publishes the whole problem. In the device's thread a tick moves the device's end of the coupling
/// to where the device is (`ToolRows`), solves the tool's island from the last impulses, and answers
///
///   F = −λ_coupling / h.
///
/// A wall that the snapshot knows is thus felt at the tick's rate, not at the loop's. Between two snapshots, however old they
/// are, F is a map of the device's position of slope ≤ k. What follows from that is in docs/theory/haptics.md.
///
///     auto& haptics = loop.channel<HapticChannel>();
///     haptics.connect(coupling);                                     // before the threads start
///     const HapticForce f = haptics.tick(device_state);              // the device's thread
///     rigid.move_to(proxy, haptics.device().position); loop.step(h); // the loop's thread
///
/// A tick never waits and allocates nothing: Everything it needs is made ready by the loop's thread.
template <class Solver = AcceleratedGaussSeidel, Clock C = SteadyClock>
struct BasicHapticChannel {
  using plays = role::Listener;
  using listens = Listens<stage::Solve>;
  static constexpr bool wants_open_contacts = true;  ///< read by the loop, whose detection then leaves none out: ticks may close them

  Solver solver{.tolerance = 1e-4, .max_iterations = 100};  ///< of a tick
  double budget = 80e-6;                                    ///< s a tick may solve, looked at after each sweep
  C clock{};  ///< of the budget
  ForceOutput output{};  ///< between the solve and the motors
  std::size_t reserve = 0;  ///< elements of an array of a snapshot, as in `DoubleBuffer`; 0: as it comes

  void check() const {
    solver.check();
    output.check();
    inner::expect_at_least_zero("HapticChannel: budget", budget, "s");
  }

  /// What `loop.channel<HapticChannel>()` returns, for both threads.
  template <class Problem>
  class Channel;

  /// Asked by the checks: says what the loop lacks, W as a matrix or a VirtualCoupling.
  template <class Problem>
  static consteval bool can_publish();

  void after(stage::Solve, const auto& loop) const { loop.template channel<BasicHapticChannel>().publish(loop); }
};

/// The state of both threads; each calls its own functions only.
template <class Solver, Clock C>
template <class Problem>
class BasicHapticChannel<Solver, C>::Channel : inner::Room {
  using Rows = typename Problem::Rows;
  using T = typename Rows::Scalar;
  using Laws = decltype(Problem::laws);
  using Timed = WithDeadline<Solver, C>;

 public:
  /// The parameters are taken here, once: the loop's copy of them may change without a race.
  explicit Channel(const BasicHapticChannel& parameters) : Room(parameters.reserve), parameters_(parameters) {
    slots_.each([&](Slot& slot) {
      auto& problem = slot.snapshot.problem;
      this->make_in(problem);
      slot.tool.reserve(parameters.reserve);
      slot.book.reserve(parameters.reserve);
      slot.book.show(problem.W, problem.rows);
      Index rows = 0;  // of the largest problem there can be
      for_each_index<Rows::pool_count>([&](auto p) { rows += Rows::template rows_of<p> * Index(parameters.reserve); });
      slot.workspace.reset(rows);
    });
  }

  using Room::skipped, Room::needed;

  // --- the loop's thread -----------------------------------------------------------------------------------------

  /// The coupling whose force the device displays.
  void connect(ConstraintHandle<VirtualCoupling> coupling) { coupling_ = coupling; }

  /// The newest state of the device that a tick was given.
  const DeviceState& device() {
    devices_.fetch();
    return devices_.front();
  }

  /// The problem of the step that was just solved; one that is not finite is kept back, and the last good one stays.
  void publish(const auto& loop) {
    if (loop.report().status == Status::quarantined) return;
    ++sequence_;
    if (!this->takes(loop)) return;
    Slot& slot = slots_.back();
    inner::take_snapshot(loop, sequence_, slot.snapshot);
    auto& problem = slot.snapshot.problem;
    if (!slot.tool.take(loop.world(), problem, coupling_)) return;
    slot.book.prepare(problem.W, problem.rows, problem.h);
    slot.workspace.reset(problem.rows.row_count());
    slots_.publish();
  }

  // --- the device's thread -----------------------------------------------------------------------------------------

  /// The force for the device where it is now. No coupling, no snapshot yet, or a state that is not finite: no force.
  HapticForce tick(const DeviceState& device) {
    HapticForce out;
    if (!device.is_finite()) {
      out.solve.status = Status::quarantined;
      return limit(out);
    }
    devices_.back() = device;
    devices_.publish();
    slots_.fetch();
    Slot& slot = slots_.front();
    out.sequence = slot.snapshot.sequence;
    out.snapshot_time = slot.snapshot.time;
    if (!slot.tool.is_there()) return limit(out);

    auto& problem = slot.snapshot.problem;
    slot.tool.move_device(problem.rows, device);
    out.solve = solve(slot);
    const Vec<6> impulse = slot.tool.impulse_on_device(problem.rows);
    out.force = linear_part(impulse) / problem.h;
    out.torque = angular_part(impulse) / problem.h;
    return limit(out);
  }

 private:
  struct Slot {
    Snapshot<Problem> snapshot;
    inner::ToolRows<Problem> tool;
    LawSet<Laws, T, inner::needs_of<Timed>> book{snapshot.problem.laws};
    typename Timed::template Workspace<Rows> workspace;
  };

  SolveReport solve(Slot& slot) const {
    auto& problem = slot.snapshot.problem;
    NoObserver nobody;
    IslandProblem island(slot.book, problem.rows, problem.W, problem.islands, slot.tool.island(), problem.h, nobody);
    slot.workspace.reset(problem.rows.row_count());  // the sizes are right: only the clock starts anew
    return Timed{parameters_.solver, parameters_.budget, parameters_.clock}.solve(island, slot.workspace);
  }

  HapticForce limit(HapticForce out) {
    const ForceOutput& limits = parameters_.output;
    if (!is_finite(out.force) || !is_finite(out.torque)) out.solve.status = Status::quarantined;
    out.force = limits(out.force, limits.max_force, filtered_force_);
    out.torque = limits(out.torque, limits.max_torque, filtered_torque_);
    return out;
  }

  const BasicHapticChannel parameters_;
  TripleBuffer<Slot> slots_;           // loop → device
  TripleBuffer<DeviceState> devices_;  // device → loop
  ConstraintHandle<VirtualCoupling> coupling_{};
  std::uint64_t sequence_ = 0;
  Vec3 filtered_force_ = zero<Vec3>(), filtered_torque_ = zero<Vec3>();
};

template <class Solver, Clock C>
template <class Problem>
consteval bool BasicHapticChannel<Solver, C>::can_publish() {
  if constexpr (std::is_void_v<Problem>) {
    static_assert(!std::is_void_v<Problem>,
                  "delassus: HapticChannel displays the force of a VirtualCoupling, and this loop has no constraints; add "
                  "Constraints{VirtualCoupling{}, ...}, or take HapticChannel out");
    return false;
  } else {
    constexpr bool is_matrix = inner::AssembledOperator<decltype(Problem::W)>;
    static_assert(is_matrix,
                  "delassus: HapticChannel solves in another thread and needs W as a matrix, which this compliance never "
                  "forms; take AssembledCompliance");
    constexpr bool has_coupling = inner::coupling_pool<Problem> >= 0;
    if constexpr (is_matrix)
      static_assert(has_coupling,
                    "delassus: HapticChannel displays the force of a VirtualCoupling, and this loop has no such law; add "
                    "VirtualCoupling{} to Constraints{...}");
    return is_matrix && has_coupling;
  }
}

/// With the default solver and the steady clock.
using HapticChannel = BasicHapticChannel<>;

}  // namespace delassus
