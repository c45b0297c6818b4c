/// Dense linear systems of any size, for what is checked and not simulated.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace delassus {

/// x with M x = b, M square and not symmetric, by elimination with row pivots; numbers that are none where M
/// is singular.
inline Eigen::VectorXd solve_dense(const Eigen::MatrixXd& M, const Eigen::VectorXd& b) {
  return M.partialPivLu().solve(b);
}

}  // namespace delassus
