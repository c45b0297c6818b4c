/// How a solve converged: error per sweep, error per constraint, force per row.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/measure.hpp>
#include <delassus/step/stage.hpp>

#include <vector>

namespace delassus {

/// Keeps the last step. It has the solver measure after every sweep, which about doubles the cost of the solve.
template <class Real>
class BasicConvergenceRecord {
 public:
  using plays = role::Listener;
  using listens = Listens<stage::Begin, stage::Solve>;
  static constexpr bool every_sweep = true;  ///< read by the loop: the solver measures after each sweep

  /// The error after one sweep of one island.
  struct Sweep {
    Index island;  ///< its number in the step
    int sweep;  ///< 0: before the first
    Measure measure;  ///< of the whole island
  };
  /// One row of the last step. `force` is λ/h, N or N·m.
  struct Row {
    int pool;  ///< place of its law in Constraints{...}
    Index item;  ///< number among the items of that law in this step
    int row;  ///< of the item, from 0
    Real force;  ///< λ/h
  };
  /// |F_i| of one constraint in velocity units, m/s: its share of the residual before the division.
  struct Constraint {
    int pool;  ///< place of its law in Constraints{...}
    Index item;  ///< number among the items of that law in this step
    Real error;  ///< |F_i|
  };

  /// One row after one sweep.
  struct Force {
    Index island;  ///< its number in the step
    int sweep;  ///< 0: before the first
    Row row;  ///< with the force after that sweep
  };

  /// With `every_force` the force of each row is kept after every sweep, too.
  explicit BasicConvergenceRecord(bool every_force = false) : every_force_(every_force) {}

  /// Of the last step, one island after the other.
  const std::vector<Sweep>& sweeps() const { return sweeps_; }
  /// Of the last step; empty without `every_force`.
  const std::vector<Force>& forces() const { return forces_; }
  const std::vector<Row>& rows() const { return rows_; }  ///< at the end of the last step's solve
  /// At the end of the last step's solve.
  const std::vector<Constraint>& constraints() const { return constraints_; }

  /// Called by the step: what follows is of this island.
  void begin_island(Index island) { island_ = island; }
  void operator()(int sweep, const Measure& m) { sweeps_.push_back({island_, sweep, m}); }
  /// Asked by the solver: `every_force`.
  bool wants_forces() const { return every_force_; }
  /// Called by the solver after a sweep, with the impulses of one item.
  void force(int sweep, int pool, Index item, const auto& lambda, double h) {
    for (int k = 0; k < int(lambda.size()); ++k) forces_.push_back({island_, sweep, {pool, item, k, double(lambda[k]) / h}});
  }

  void after(stage::Begin, const auto&) {
    sweeps_.clear();
    forces_.clear();
    rows_.clear();
    constraints_.clear();
  }
  void after(stage::Solve, const auto& loop) {
    loop.each_constraint([&](int pool, Index item, const auto& lambda, double error, double h) {
      for (int k = 0; k < int(lambda.size()); ++k) rows_.push_back({pool, item, k, double(lambda[k]) / h});
      constraints_.push_back({pool, item, error});
    });
  }

 private:
  bool every_force_ = false;
  Index island_ = 0;
  std::vector<Sweep> sweeps_;
  std::vector<Force> forces_;
  std::vector<Row> rows_;
  std::vector<Constraint> constraints_;
};

/// Keeps doubles.
using ConvergenceRecord = BasicConvergenceRecord<double>;

}  // namespace delassus
