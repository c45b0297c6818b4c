/// How a step, or the solve of one island, ended.
#pragma once

#include <algorithm>
#include <cstdint>

namespace delassus {

/// In order of severity: the status of a step is the worst of its islands'.
enum class Status : std::uint8_t {
  converged,          ///< the residual is within the tolerance
  stalled,            ///< the rounding floor was met above the tolerance; the result is the best seen
  max_iterations,     ///< the sweeps ran out; the result is the best that the solver kept
  deadline,           ///< the time ran out; the result is the best measured
  infeasible,         ///< proved: the rows contradict each other; the result is a compromise between them
  unclaimed_contact,  ///< a contact exists that no contact law takes
  quarantined,        ///< a non-finite number appeared: that island was left where it was
};

constexpr Status worse(Status a, Status b) { return std::max(a, b); }

constexpr const char* name(Status status) {
  switch (status) {
    case Status::converged: return "converged";
    case Status::stalled: return "stalled";
    case Status::max_iterations: return "max_iterations";
    case Status::deadline: return "deadline";
    case Status::infeasible: return "infeasible";
    case Status::unclaimed_contact: return "unclaimed_contact";
    case Status::quarantined: return "quarantined";
  }
  return "unknown";
}

}  // namespace delassus
