/// The Delassus operator of soft bodies by a factor that is kept while it serves.
#pragma once

#include <delassus/compliance/inner/refine.hpp>
#include <delassus/compliance/inner/rotated_operator.hpp>
#include <delassus/core/expect.hpp>


namespace delassus {

/// W̃ from an old factor of A, turned with the nodes. The rows are solved, and what W̃ missed of W is put right,
/// until they are off by no more than `violation` in the step. The motion itself is that of the A of the
/// step, by conjugate gradients. A is factored anew when the solves of a step took too long or when passes
/// bring too little. S is the scalar of the factor. Bodies that are not soft are as with
/// `AssembledCompliance`.
template <class S>
struct BasicLazyCompliance {
  using plays = role::Compliance;
  static constexpr bool refines = true;
  template <class Base>
  using stages = inner::RefinedStages<Base>;
  double violation = 1e-5;   ///< m, rad
  double tolerance = 1e-6;   ///< |p − A Δv| ≤ tolerance |p|
  int max_iterations = 8;    ///< of conjugate gradients; with 0 A is factored in every step
  double contraction = 0.3;  ///< what a pass may leave of the violation before the factor is old
  int max_passes = 10;       ///< solves of the rows after the first; then the status is max_iterations
  ComplianceReport report{};  ///< of the last step

  void check() const {
    inner::expect_positive("LazyCompliance: violation", violation, "m");
    inner::expect_number(tolerance > 0 && tolerance < 1, "LazyCompliance: tolerance", tolerance,
                         "must lie in (0, 1)");
    DELASSUS_EXPECT(max_iterations >= 0 && max_passes >= 0,
                    "LazyCompliance: max_iterations and max_passes must be >= 0");
    inner::expect_number(contraction > 0 && contraction < 1, "LazyCompliance: contraction", contraction,
                         "must lie in (0, 1)");
  }
  /// For its operator.
  inner::RotatedLimits limits() const {
    return {violation, tolerance, contraction, max_iterations, max_passes};
  }

  template <class Rows>
  class Operator : public inner::RotatedOperator<S, Rows, inner::FactorOfAStep> {};
};
using LazyCompliance = BasicLazyCompliance<float>;  ///< with its factor in float

}  // namespace delassus
