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
  static constexpr bool every_sweep = true;

  struct Sweep {
    Index island;
    int sweep;  ///< 0: before the first
    Measure measure;
  };
  /// One row of the last step. `force` is λ/h, N or N·m.
  struct Row {
    int pool;
    Index item;
    int row;
    Real force;
  };
  /// |F_i| of one constraint in velocity units, m/s: its share of the residual before the division.
  struct Constraint {
    int pool;
    Index item;
    Real error;
  };

  /// One row after one sweep.
  struct Force {
    Index island;
    int sweep;
    Row row;
  };

  /// With `every_force` the force of each row is kept after every sweep, too.
  explicit BasicConvergenceRecord(bool every_force = false) : every_force_(every_force) {}

  const std::vector<Sweep>& sweeps() const { return sweeps_; }
  const std::vector<Force>& forces() const { return forces_; }
  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Constraint>& constraints() const { return constraints_; }

  void begin_island(Index island) { island_ = island; }
  void operator()(int sweep, const Measure& m) { sweeps_.push_back({island_, sweep, m}); }
  bool wants_forces() const { return every_force_; }
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

using ConvergenceRecord = BasicConvergenceRecord<double>;

}  // namespace delassus
