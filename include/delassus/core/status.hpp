/// How a step, or the solve of one island, ended.
#pragma once

#include <algorithm>
#include <cstddef>
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

/// The later one in the order of severity.
constexpr Status worse(Status a, Status b) { return std::max(a, b); }

namespace inner {

/// The name of an enumerator, in the order in which its enumeration declares them.
template <class Enum, std::size_t count>
constexpr const char* name_in(const char* const (&names)[count], Enum value) {
  return std::size_t(value) < count ? names[std::size_t(value)] : "unknown";
}

}  // namespace inner

/// As the enumerator is written, for messages and tables.
constexpr const char* name(Status status) {
  constexpr const char* names[] = {"converged", "stalled", "max_iterations", "deadline",
                                   "infeasible", "unclaimed_contact", "quarantined"};
  return inner::name_in(names, status);
}

}  // namespace delassus
