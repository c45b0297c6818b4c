/// A friction problem as Siconos holds it, and the configurations of Siconos that are compared.
#pragma once

#include <delassus/problems/friction_problem.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <NumericsVerbose.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>

/// W as Siconos' matrix of 3 × 3 blocks, row by row with ascending columns, each block column-major; q and μ
/// beside it. What Siconos converts W to inside of a solve is kept in the matrix, so that every timed run
/// wants a new one.
class GivenToSiconos {
 public:
  explicit GivenToSiconos(const delassus::FrictionProblem& p) {
    using delassus::Index;
    const auto W = p.W.blocks<0, 0>();
    const auto& pool = p.rows.pool<0>();
    const Index n = pool.items();
    start_.push_back(0);
    for (Index i = 0; i < n; ++i) {
      std::vector<std::pair<Index, const double*>> row{{i, p.W.diagonal<0>(i).data()}};
      for (Index e = W.start[i]; e < W.start[i + 1]; ++e) row.push_back({W.column[e], W.block[e].data()});
      std::sort(row.begin(), row.end());
      for (const auto& [column, block] : row) {
        column_.push_back(std::size_t(column));
        block_.push_back(const_cast<double*>(block));  // Siconos reads it only
      }
      start_.push_back(column_.size());
      end_.push_back(3 * unsigned(i + 1));
      for (int k = 0; k < 3; ++k) q_.push_back(pool.d[i][k]);
      mu_.push_back(p.laws.pool<0>().item(i).parameters.friction);
    }
    blocks_ = SBM_new();
    blocks_->nbblocks = unsigned(column_.size());
    blocks_->block = block_.data();
    blocks_->blocknumber0 = blocks_->blocknumber1 = unsigned(n);
    blocks_->blocksize0 = blocks_->blocksize1 = end_.data();
    blocks_->filled1 = std::size_t(n) + 1;
    blocks_->filled2 = column_.size();
    blocks_->index1_data = start_.data();
    blocks_->index2_data = column_.data();
    matrix_ = static_cast<NumericsMatrix*>(NM_create_from_data(NM_SPARSE_BLOCK, 3 * n, 3 * n, blocks_));
    problem_ = frictionContactProblem_new_with_data(3, n, matrix_, q_.data(), mu_.data());
  }
  GivenToSiconos(const GivenToSiconos&) = delete;  // the arrays are pointed at
  GivenToSiconos& operator=(const GivenToSiconos&) = delete;

  /// Never freed: a process that solves ends soon, and Siconos would free arrays that are ours.
  FrictionContactProblem* get() { return problem_; }

 private:
  std::vector<double*> block_;
  std::vector<std::size_t> start_, column_;
  std::vector<unsigned> end_;
  std::vector<double> q_, mu_;
  SparseBlockStructuredMatrix* blocks_;
  NumericsMatrix* matrix_;
  FrictionContactProblem* problem_;
};

/// A solver of Siconos with what it is told besides the tolerance: numbers are Siconos' defaults but where
/// stated.
struct Configuration {
  const char* name;
  int solver;
  int local = 0;            ///< the solver of one contact; 0: the default
  bool full_error = false;  ///< the whole error every tenth sweep, in place of the cheap one in each
  double relaxation = 1;
  bool sweeps = false;  ///< Gauss-Seidel: has a cost per sweep

  SolverOptions* options(double tolerance, int max_iterations) const {
    SolverOptions* o = solver_options_create(solver);
    o->dparam[SICONOS_DPARAM_TOL] = tolerance;
    o->iparam[SICONOS_IPARAM_MAX_ITER] = max_iterations;
    if (local != 0) solver_options_update_internal(o, 0, local);
    if (local == SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnConeWithLocalIteration)
      o->internalSolvers[0]->iparam[SICONOS_IPARAM_MAX_ITER] = 10;
    if (full_error) {
      o->iparam[SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION] = SICONOS_FRICTION_3D_NSGS_ERROR_EVALUATION_FULL;
      o->iparam[SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION_FREQUENCY] = 10;
    }
    if (relaxation != 1) {
      o->iparam[SICONOS_FRICTION_3D_NSGS_RELAXATION] = SICONOS_FRICTION_3D_NSGS_RELAXATION_TRUE;
      o->dparam[SICONOS_FRICTION_3D_NSGS_RELAXATION_VALUE] = relaxation;
    }
    return o;
  }
};

inline const std::vector<Configuration>& configurations() {
  constexpr int nsgs = SICONOS_FRICTION_3D_NSGS;
  static const std::vector<Configuration> all{
      {.name = "NSGS", .solver = nsgs, .sweeps = true},
      {.name = "NSGS-QUARTIC",
       .solver = nsgs,
       .local = SICONOS_FRICTION_3D_ONECONTACT_QUARTIC,
       .sweeps = true},
      {.name = "NSGS-QUARTIC-full",
       .solver = nsgs,
       .local = SICONOS_FRICTION_3D_ONECONTACT_QUARTIC,
       .full_error = true},
      {.name = "NSGS-NSN_GP", .solver = nsgs, .local = SICONOS_FRICTION_3D_ONECONTACT_NSN_GP, .sweeps = true},
      {.name = "NSGS-NSN_GP-full",
       .solver = nsgs,
       .local = SICONOS_FRICTION_3D_ONECONTACT_NSN_GP,
       .full_error = true},
      {.name = "NSGS-projection",
       .solver = nsgs,
       .local = SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnConeWithLocalIteration,
       .sweeps = true},
      {.name = "NSGS-relaxed", .solver = nsgs, .relaxation = 1.4},
      {.name = "NSN_AC", .solver = SICONOS_FRICTION_3D_NSN_AC},
      {.name = "NSN_AC_TEST", .solver = SICONOS_FRICTION_3D_NSN_AC_TEST},
      {.name = "NSN_NM", .solver = SICONOS_FRICTION_3D_NSN_NM},
      {.name = "ADMM", .solver = SICONOS_FRICTION_3D_ADMM},
      {.name = "PROX", .solver = SICONOS_FRICTION_3D_PROX},
      {.name = "VI_EG", .solver = SICONOS_FRICTION_3D_VI_EG},
  };
  return all;
}
