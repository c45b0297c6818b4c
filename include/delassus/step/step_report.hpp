/// What a step says of itself.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/core/status.hpp>

namespace delassus {

/// The worst of all islands, and the counts of the step. Returned by every step; nothing in it is optional reading for
/// a host that cares: not converging is a value, not an exception.
struct StepReport {
  Status status = Status::converged;  ///< the most severe one
  int sweeps = 0;                 ///< of the island that took most
  double residual = 0;            ///< `Measure::residual`, largest of the islands
  double natural_map_error = 0;   ///< `Measure::siconos`, largest of the islands
  double max_penetration = 0;     ///< m, at the start of the step
  double max_joint_violation = 0; ///< m or rad, at the start of the step
  bool starts_apart = false;      ///< of a loop's first step: the ends of a joint are far from each other, see `what_is_odd`
  bool overlaps_unseen = false;   ///< of a loop's first step: shapes overlap and no contact law is named
  Index contacts = 0;             ///< points, whether a law takes them or not
  Index rows = 0;
  /// Contacts and stops that push, in islands of at least three of them whose loads no rule decides: redundant ones may share a load
  /// otherwise and make the same motion.
  Index undecided_loads = 0;
  Index islands = 0;              ///< groups that were solved on their own
  Index quarantined = 0;          ///< bodies left where they were because something was not finite
  Index pairs = 0;                ///< near pairs from the broad phase
  Index queries = 0;              ///< narrow-phase queries
  Index rejects = 0;              ///< answers of the collision backend that failed their certificate
  double time = 0;                ///< s, simulated, at the end of the step
};

}  // namespace delassus
