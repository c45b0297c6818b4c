/// The Delassus operator of soft bodies by the compliance they have at rest.
#pragma once

#include <delassus/compliance/inner/compliance_file.hpp>
#include <delassus/compliance/inner/refine.hpp>
#include <delassus/compliance/inner/rotated_operator.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/sort.hpp>

#include <string>

namespace delassus {
namespace inner {

/// Factors are of the A at rest, and all nodes of the surface are known from the start, by a file if there is
/// one.
class FactorAtRest {
 public:
  static constexpr bool is_at_rest = true;

  void begin(const auto& policy) {
    if (file_.empty()) file_ = policy.file;
  }

  /// The k-th body of its set has a new factor: the first one comes from its file, or makes it.
  void complete(Index k, auto& inverse, const auto& body) {
    if (std::size_t(k) >= is_filed_.size()) is_filed_.resize(std::size_t(k) + 1, 0);
    const bool has_file = !file_.empty() && !is_filed_[k];
    is_filed_[k] = 1;
    const std::string path = k == 0 ? file_ : file_ + "." + std::to_string(k);
    const ComplianceKeys keys = has_file ? ComplianceKeys::of(body) : ComplianceKeys{};
    if (has_file && read_compliance(path, keys, inverse)) return;
    Array<Index> nodes;
    for (const auto& triangle : surface(body.mesh())) nodes.append(triangle.begin(), triangle.end());
    inner::sort(nodes);
    inner::drop_repeats(nodes);
    inverse.know(nodes, false);
    if (has_file) write_compliance(path, keys, inverse);
  }

 private:
  std::string file_;
  Array<char> is_filed_;
};

}  // namespace inner

/// As `BasicLazyCompliance`, with the factor of A at rest, which is kept for good, and the compliance of all
/// nodes of the surface made in the first step: 9 s² numbers of S for s nodes. For soft bodies that turn as
/// they like and bend little. With a `file` that is there, the numbers are read from it. The first step then
/// refuses one of another mesh, material, step, damping or other fixed nodes. With one that is not there, they
/// are written to it. The k-th body of a set has the file `file`.k, the first one `file` itself.
template <class S>
struct BasicPrecomputedCompliance {
  using plays = role::Compliance;
  static constexpr bool refines = true;
  template <class Base>
  using stages = inner::RefinedStages<Base>;
  double violation = 1e-5;  ///< m, rad
  double tolerance = 1e-6;  ///< |p − A Δv| ≤ tolerance |p|
  int max_passes = 30;      ///< solves of the rows after the first; then the status is max_iterations
  std::string file{};       ///< a path; empty: nothing is read or written
  ComplianceReport report{};  ///< of the last step

  void check() const {
    inner::expect_positive("PrecomputedCompliance: violation", violation, "m");
    inner::expect_number(tolerance > 0 && tolerance < 1, "PrecomputedCompliance: tolerance", tolerance,
                         "must lie in (0, 1)");
    DELASSUS_EXPECT(max_passes >= 0, "PrecomputedCompliance: max_passes must be >= 0");
  }
  /// For its operator; a factor is never too old.
  inner::RotatedLimits limits() const { return {violation, tolerance, 1, 0, max_passes}; }

  template <class Rows>
  class Operator : public inner::RotatedOperator<S, Rows, inner::FactorAtRest> {};
};
using PrecomputedCompliance = BasicPrecomputedCompliance<float>;  ///< with its numbers in float

}  // namespace delassus
