/// What one constraint keeps while Newton's method runs.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

namespace delassus::inner {

/// One constraint in the equations of `BodySpace`. Everything is double, whatever the rows are.
template <int R>
struct NewtonItem {
  Index item;              ///< its number in the pool
  Index first, last;       ///< its sides
  double weight;           ///< w = tr(W_ii)/R
  Vec<R> compliance;       ///< on W's diagonal, beside H A⁻¹ Hᵀ
  Vec<R> best;             ///< λ of the smallest measured error
  Vec<R> centre;           ///< λ̂
  Vec<R> velocity, trial;  ///< u = d + W λ̂ + H y, here and one step further
  Vec<R> lambda;           ///< λ(u)
  Vec<R> error;            ///< H F
  Vec<R> move;             ///< H δ
  Mat<R, R> slope;         ///< S = −∂λ/∂u
};

/// H and G = A⁻¹ Hᵀ of a constraint on one of the blocks that move; narrower sets are filled up with zeros.
template <int R, int w>
struct NewtonSide {
  Index block;
  Mat<R, w> H;
  Mat<w, R> G;
};

}  // namespace delassus::inner
